package racebeam;

import java.util.ArrayList;
import java.util.Collections;
import java.util.List;

/**
 * The result of a list of actions of {@code branch}.
 *
 * @param rewards the reward of each act
 * @param rewardsB the rewards of player B; empty if the game's rules have only one player
 * @param group the whole group: reward, acts, terminated, truncated, lives, and state with {@code keep}
 */
public record Branch(List<Long> rewards, List<Long> rewardsB, Group group) {
  static Branch of(Group group) {
    return new Branch(rewards(group, "rewards"), rewards(group, "rewards_b"), group);
  }

  /**
   * Returns the sum of the rewards.
   *
   * @return the field reward
   */
  public long reward() {
    return group.reward();
  }

  private static List<Long> rewards(Group group, String key) {
    List<Long> rewards = new ArrayList<>();
    for (String run : group.has(key) ? group.list(key) : List.<String>of()) {
      String[] parts = run.split("\\*");
      rewards.addAll(Collections.nCopies(parts.length == 1 ? 1 : Integer.parseInt(parts[1]), Long.valueOf(parts[0])));
    }
    return rewards;
  }
}
