import java.util.Arrays;
import java.util.Map;
import java.util.Random;
import racebeam.Group;
import racebeam.Racebeam;
import racebeam.Session;

/**
 * An agent that learns to play Beamfall: linear SARSA(lambda) with replacing traces (Sutton and Barto, Reinforcement Learning,
 * 12.7) over binary features of RAM. Usage: {@code java -cp racebeam.jar Sarsa.java [EPISODES]}, with the server's address in
 * RACEBEAM_ADDRESS. Prints the mean score of each ten episodes.
 */
public final class Sarsa {
  private static final double STEP_SIZE = 0.1; // shared by the active features
  private static final double DISCOUNT = 0.98;
  private static final double TRACE_DECAY = 0.8;
  private static final double EXPLORATION = 0.02;
  private static final String[] ACTIONS = {"FIRE", "RIGHTFIRE", "LEFTFIRE"};

  // Variables of Beamfall in RAM (games/homebrew/README.md).
  private static final int SHIP_X = 6;
  private static final int BEAM_ROW = 14;
  private static final int BEAM = 15; // three bytes for each half; a bit that is 1 burns

  private static final int WIDE = 4; // cells of a gap that the ship fits into
  private static final int FAR = 10; // cells; gaps beyond it are alike
  private static final int WAYS = 2 * FAR + 2; // to the left, here, to the right, and none
  private static final int HEIGHTS = 12; // of the beam, in steps of eight rows
  private static final int ACTIVE = 2; // features that are 1 at a time
  private static final int FEATURES = WAYS * (1 + HEIGHTS);

  private final double[][] weights = new double[ACTIONS.length][FEATURES];
  private final double[][] traces = new double[ACTIONS.length][FEATURES];
  private final Random random = new Random(1);

  public static void main(String[] words) throws Exception {
    int episodes = words.length > 0 ? Integer.parseInt(words[0]) : 100;
    Sarsa agent = new Sarsa();
    try (Session game = Racebeam.connect()) {
      game.load("beamfall", Map.of("seed", 1, "frame_skip", 6, "max_episode_frames", 12000));
      game.observe("reward", "terminated", "truncated", "lives", "ram");
      long sum = 0;
      for (int episode = 1; episode <= episodes; ++episode) {
        sum += agent.play(game);
        if (episode % 10 == 0) {
          System.out.printf("episodes %d to %d: mean score %.1f%n", episode - 9, episode, sum / 10.0);
          sum = 0;
        }
      }
    }
  }

  /** Plays an episode, and learns from it. Returns the score. */
  private long play(Session game) throws Exception {
    for (double[] trace : traces) {
      Arrays.fill(trace, 0);
    }
    Group shown = game.reset();
    int[] features = features(shown.bytes("ram"));
    int action = choose(features);
    long score = 0;
    while (true) {
      int lives = shown.lives();
      shown = game.act(ACTIONS[action]);
      score += shown.reward();
      double reward = shown.reward() / 10.0 - (shown.lives() < lives ? 10 : 0);
      if (shown.isOver()) {
        learn(features, action, reward - value(features, action));
        return score;
      }
      int[] next = features(shown.bytes("ram"));
      int nextAction = choose(next);
      learn(features, action, reward + DISCOUNT * value(next, nextAction) - value(features, action));
      features = next;
      action = nextAction;
    }
  }

  /** The features that are 1: the way to the nearest gap of the beam, alone and with the height of the beam. */
  private static int[] features(byte[] ram) {
    int way = way(ram);
    int height = Math.min((ram[BEAM_ROW] & 0xFF) / 8, HEIGHTS - 1);
    return new int[] {way, WAYS * (1 + height) + way};
  }

  /** Where the nearest wide gap is: FAR if it is here, less if it is to the left. 2 * FAR + 1: none is near. */
  private static int way(byte[] ram) {
    boolean[] burns = beam(ram);
    double ship = ((ram[SHIP_X] & 0xFF) + 10) / 4.0;
    double nearest = FAR + 1;
    int gap = 0;
    for (int cell = 0; cell <= burns.length; ++cell) {
      if (cell < burns.length && !burns[cell]) {
        ++gap;
        continue;
      }
      double middle = cell - gap / 2.0;
      if (gap >= WIDE && Math.abs(middle - ship) < Math.abs(nearest)) {
        nearest = middle - ship;
      }
      gap = 0;
    }
    return nearest > FAR ? 2 * FAR + 1 : Math.max(0, (int) Math.round(nearest) + FAR);
  }

  /** The 40 cells of the beam, from left to right: PF0 has four, PF1 has its bits the other way round. */
  private static boolean[] beam(byte[] ram) {
    boolean[] burns = new boolean[40];
    for (int cell = 0; cell < burns.length; ++cell) {
      int place = cell % 20;
      int half = BEAM + 3 * (cell / 20);
      int bit = place < 4 ? ram[half] >> (4 + place) : place < 12 ? ram[half + 1] >> (11 - place) : ram[half + 2] >> (place - 12);
      burns[cell] = (bit & 1) == 1;
    }
    return burns;
  }

  private double value(int[] features, int action) {
    double value = 0;
    for (int feature : features) {
      value += weights[action][feature];
    }
    return value;
  }

  private int choose(int[] features) {
    if (random.nextDouble() < EXPLORATION) {
      return random.nextInt(ACTIONS.length);
    }
    int best = 0;
    for (int action = 1; action < ACTIONS.length; ++action) {
      if (value(features, action) > value(features, best)) {
        best = action;
      }
    }
    return best;
  }

  private void learn(int[] features, int action, double error) {
    for (int other = 0; other < ACTIONS.length; ++other) {
      for (int feature = 0; feature < FEATURES; ++feature) {
        traces[other][feature] *= DISCOUNT * TRACE_DECAY;
      }
    }
    for (int feature : features) {
      traces[action][feature] = 1;
    }
    for (int other = 0; other < ACTIONS.length; ++other) {
      for (int feature = 0; feature < FEATURES; ++feature) {
        weights[other][feature] += STEP_SIZE / ACTIVE * error * traces[other][feature];
      }
    }
  }
}
