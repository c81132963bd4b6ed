package racebeam;

import java.util.List;

/**
 * A reply: {@code ok}, and groups. The first group is about the request as a whole; the others are about machines or
 * branches.
 *
 * @param groups at least one
 * @param line as the server sent it
 */
public record Reply(List<Group> groups, String line) {
  /**
   * The group about the request as a whole.
   *
   * @return the first group
   */
  public Group first() {
    return groups.get(0);
  }

  /**
   * The groups of machines or branches.
   *
   * @return the groups after the first
   */
  public List<Group> rest() {
    return groups.subList(1, groups.size());
  }
}
