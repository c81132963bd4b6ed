import java.util.ArrayList;
import java.util.List;
import java.util.Map;
import racebeam.Branch;
import racebeam.Group;
import racebeam.Racebeam;
import racebeam.Session;

/**
 * A planner: at each step, it tries each action with {@code branch} from where the game is, and plays the best. Usage:
 * {@code java -cp racebeam.jar Planner.java [STEPS]}, with the server's address in RACEBEAM_ADDRESS.
 */
public final class Planner {
  private static final int DEPTH = 20; // acts that a branch looks ahead

  public static void main(String[] words) throws Exception {
    int steps = words.length > 0 ? Integer.parseInt(words[0]) : 100;
    try (Session game = Racebeam.connect()) {
      game.load("beamfall", Map.of("seed", 1, "sticky", 0, "frame_skip", 4));
      game.observe("reward", "terminated", "truncated");
      List<String> actions = List.copyOf(game.actions().values());
      List<List<String>> lists = new ArrayList<>();
      actions.forEach(action -> lists.add(List.of(action, "FIRE*" + DEPTH)));
      long score = 0;
      boolean over = false;
      for (int step = 0; step < steps && !over; ++step) {
        game.save("here");
        Group shown = game.act(actions.get(best(game.branch("here", lists))));
        score += shown.reward();
        over = shown.isOver();
      }
      System.out.println("score " + score + ", " + game.stats().number("frames") + " frames run");
    }
  }

  /** The branch with the highest reward; of equal ones, the one with more lives. */
  private static int best(List<Branch> branches) {
    int best = 0;
    for (int at = 1; at < branches.size(); ++at) {
      if (value(branches.get(at)) > value(branches.get(best))) {
        best = at;
      }
    }
    return best;
  }

  private static double value(Branch branch) {
    return branch.reward() + 100 * branch.group().lives();
  }
}
