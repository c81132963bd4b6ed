#!/usr/bin/env python3
"""SARSA(lambda) with Basic features (Bellemare et al. 2013): an agent that learns a game over the line protocol.

It needs NumPy, for --curve Matplotlib, for --log the package racebeam, and for a progress bar tqdm. With the same
seeds, it chooses what the agent `basic` of `racebeam experiment` chooses.
"""

import argparse
import contextlib
import datetime
import pathlib
import sys
import time

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE / "single_file"))
from client import Refused, Session, connect  # noqa: E402

try:
    from tqdm import tqdm
except ImportError:
    tqdm = None

ACTIONS = 18
WIDTH, HEIGHT, COLOURS = 160, 210, 128
TILE_WIDTH, TILE_HEIGHT = 10, 15  # pixels; 16 x 14 tiles
STEP_SIZE = 0.5  # alpha, divided by the largest number of active features so far
DISCOUNT, DECAY = 0.999, 0.9  # gamma, lambda
FRAME_SKIP = 5  # frames of a step, in the preset paper2013
EXPLORATION = 0.05  # epsilon, in evaluation too
LEAST_TRACE = np.float32(0.01)  # smaller traces are dropped
MEASURED_STEPS = 100  # for the time in the plan


class Random:
    """SplitMix64 (Steele, Lea and Flood 2014)."""

    def __init__(self, seed):
        self.state = seed

    def next(self):
        """Returns the next number of 64 bits."""
        self.state = z = (self.state + 0x9E3779B97F4A7C15) % 2**64
        z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9 % 2**64
        z = (z ^ z >> 27) * 0x94D049BB133111EB % 2**64
        return z ^ z >> 31

    def below(self, count):
        """Returns a number from 0 to `count` - 1."""
        number = self.next()
        while number < 2**64 % count:  # otherwise small remainders would be more likely
            number = self.next()
        return number % count

    def uniform(self):
        """Returns a number from 0 to 1, without 1."""
        return (self.next() >> 11) / 2**53


class Basic:
    """Features of a screen: which colours, other than the background's, occur in which tiles."""

    SIZE = WIDTH // TILE_WIDTH * (HEIGHT // TILE_HEIGHT) * COLOURS

    def __init__(self, background):
        self.background = background
        rows, columns = np.arange(HEIGHT) // TILE_HEIGHT, np.arange(WIDTH) // TILE_WIDTH
        self.first = (
            (rows[:, None] * (WIDTH // TILE_WIDTH) + columns) * COLOURS
        ).ravel()  # feature of each pixel's tile

    def active(self, screen):
        """Returns the features of a screen of palette indices, in ascending order. Missing rows are black."""
        colours = np.zeros(WIDTH * HEIGHT, np.uint8)
        pixels = np.frombuffer(screen, np.uint8)[: WIDTH * HEIGHT]
        colours[: len(pixels)] = pixels >> 1
        differing = np.flatnonzero(colours != self.background)
        return np.unique(self.first[differing] + colours[differing])


class Sarsa:
    """Linear SARSA with replacing traces, one for each feature and action."""

    def __init__(self, features, seed):
        self.weights = np.zeros((features, ACTIONS), np.float32)
        self.traces, self.live = (
            np.zeros(features * ACTIONS, np.float32),
            np.empty(0, np.intp),
        )  # live: indices of the traces that are not 0
        self.most_active, self.first_reward = 1, 0.0
        self.random, self.learning = Random(seed), True

    def keep(self, path):
        """Writes what was learned into a file."""
        with open(path, "wb") as file:
            np.savez_compressed(file, weights=self.weights, learned=[self.most_active, self.first_reward])

    def restore(self, path):
        """Reads a file that keep() wrote."""
        with np.load(path) as file:
            weights, (self.most_active, self.first_reward) = file["weights"], file["learned"].tolist()
        if weights.shape != self.weights.shape:
            raise ValueError(f"its weights have the shape {weights.shape}, not {self.weights.shape}")
        self.weights = weights

    def begin(self, features):
        """Begins an episode. Returns the first action."""
        self.traces[self.live] = 0
        self.live = np.empty(0, np.intp)
        return self.choose(features, self.values(features))

    def next(self, reward, features):
        """Learns from a step. Returns the next action."""
        before, scaled = self.value_before(), self.scaled(reward)
        values = self.values(features)
        taken, active = self.action, self.features
        action = self.choose(features, values)
        self.learn(active, taken, scaled + DISCOUNT * float(values[action]) - before)
        return action

    def end(self, reward):
        """Learns from the last step of an episode."""
        before, scaled = self.value_before(), self.scaled(reward)
        self.learn(self.features, self.action, scaled - before)

    def values(self, features):
        """Returns the values of all actions. The order of the sums is fixed, so that each computer gets the same."""
        return np.cumsum(self.weights[features], axis=0, dtype=float)[-1] if len(features) else np.zeros(ACTIONS)

    def value_before(self):
        """Returns the value of the last action in the features that it was chosen for."""
        return float(self.values(self.features)[self.action])

    def choose(self, features, values):
        """Chooses an action: the best one, or sometimes a random one."""
        if self.random.uniform() < EXPLORATION:
            action = self.random.below(ACTIONS)
        else:
            best = np.flatnonzero(values == values.max())
            action = int(best[0 if len(best) == 1 else self.random.below(len(best))])
        self.features, self.action = features, action
        return action

    def scaled(self, reward):
        """Divides the reward by the absolute value of the first reward that is not 0."""
        self.first_reward = self.first_reward or abs(reward)
        return reward / self.first_reward if reward else 0.0

    def learn(self, active, taken, error):
        """Moves the weights of the traces by an error of the value of an action."""
        if not self.learning:
            return
        replaced = active * ACTIONS + taken
        self.traces[replaced] = 1
        self.most_active = max(self.most_active, len(active))
        step = STEP_SIZE / self.most_active * error
        if not np.isfinite(step):
            sys.exit("sarsa.py: the weights diverged")
        live = np.union1d(self.live, replaced)
        self.weights.reshape(-1)[live] += np.float32(step) * self.traces[live]
        decayed = self.traces[live] * np.float32(DISCOUNT * DECAY)
        self.traces[live] = np.where(decayed < LEAST_TRACE, np.float32(0), decayed)
        self.live = live[decayed >= LEAST_TRACE]


def play(session, agent, basic, load, film):
    """Plays an episode, and records it as `film` if that is a name. Returns its score and the actions."""
    session.load(**load)
    if film:
        session.record("gif", film)
    session.observe("reward", "terminated", "truncated", "screen:zlib")
    score, actions = 0, [agent.begin(basic.active(session.look("screen:zlib")["screen"]))]
    while True:
        reply = session.act(actions[-1])
        score += reply["reward"]
        if reply["terminated"] or reply["truncated"]:
            agent.end(reply["reward"])
            if film:
                session.stop_recording()
            return score, actions
        actions.append(agent.next(reply["reward"], basic.active(reply["screen"])))


def random_score(session, options, episodes=5):
    """Plays episodes with random actions. Returns their mean score, the baseline of the curve."""
    random, total = Random(options.agent_seed), 0
    for episode in range(episodes):
        session.load(**load_of(options, options.seed + episode))
        session.observe("reward", "terminated", "truncated")
        reply = {"terminated": 0, "truncated": 0}
        while not (reply["terminated"] or reply["truncated"]):
            reply = session.act(random.below(ACTIONS))
            total += reply["reward"]
    return total / episodes


def draw(path, steps, scores, baseline, title):
    """Draws the score of each episode, their mean over the last 5, and the score of random play."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    means = [np.mean(scores[max(0, end - 5) : end]) for end in range(1, len(scores) + 1)]
    _, axes = pyplot.subplots(figsize=(7, 4.5), layout="constrained")
    axes.plot(steps, scores, ".", label="an episode")
    axes.plot(steps, means, label="mean of the last 5 episodes")
    axes.axhline(baseline, color="grey", linestyle="--", label=f"random play: {baseline:.1f}")
    axes.set(title=title, xlabel="steps", ylabel="score of an episode")
    axes.set_xlim(0)
    axes.xaxis.set_major_formatter("{x:,.0f}")
    axes.yaxis.set_major_formatter("{x:,.0f}")
    axes.grid(alpha=0.3)
    axes.legend()
    pyplot.savefig(path, dpi=120)


def load_of(options, seed):
    """Returns the settings of an episode."""
    return {"game": options.game, "preset": "paper2013", "seed": seed, "max_episode_frames": options.frames}


def write_log(options, seed, actions):
    """Writes the log of an episode, which `racebeam verify` confirms."""
    sys.path[:] = [entry for entry in sys.path if entry != str(HERE)]  # the package in this folder is not compiled
    try:
        from racebeam import episode_log
    except ImportError as missing:
        sys.exit(f"sarsa.py: --log needs the package racebeam: {missing}")
    how = {"seed": seed, "frame_skip": FRAME_SKIP, "max_episode_frames": options.frames}
    episode_log.write_log(options.log, options.game, actions, **how, agent="basic", agent_seed=options.agent_seed)


def seconds_per_step(session, basic, options):
    """Plays some steps with another agent, and returns the mean time of one."""
    load = {**load_of(options, options.seed), "max_episode_frames": MEASURED_STEPS * FRAME_SKIP}
    start = time.monotonic()
    _, actions = play(session, Sarsa(Basic.SIZE, options.agent_seed), basic, load, None)
    return (time.monotonic() - start) / len(actions)


def count_episodes(number):
    """Returns a number of episodes in words."""
    return f"{number} episode{'' if number == 1 else 's'}"


def print_plan(session, basic, options):
    """Prints what the program is going to play, and how long this takes."""
    training = f"{options.steps:,} steps" if options.steps else count_episodes(options.training)
    steps_of_episode = -(-options.frames // FRAME_SKIP)
    episodes = options.evaluation + (0 if options.steps else options.training)
    steps = (options.steps or 0) + episodes * steps_of_episode
    estimate = datetime.timedelta(seconds=round(steps * seconds_per_step(session, basic, options)))
    print(
        f"plan: {training} with learning and {count_episodes(options.evaluation)} without, of up to "
        f"{options.frames:,} frames; {'about' if options.steps else 'at most'} {steps:,} steps in {estimate} (h:mm:ss)",
        file=sys.stderr,
    )


class Progress(contextlib.AbstractContextManager):
    """A bar of tqdm, where that is installed and standard error is a terminal."""

    def __init__(self, options):
        total, unit = (
            (options.steps, " steps") if options.steps else (options.training + options.evaluation, " episodes")
        )
        self.bar = tqdm(total=total, unit=unit, disable=None) if tqdm else None
        self.counts_steps = bool(options.steps)

    def print(self, line, steps):
        """Prints a line for an episode of this number of steps, above the bar."""
        if self.bar is not None:
            self.bar.clear()
        print(line, flush=True)
        if self.bar is not None:
            self.bar.update(min(steps, self.bar.total - self.bar.n) if self.counts_steps else 1)

    def __exit__(self, *_):
        if self.bar is not None:
            self.bar.close()


def schedule(options, steps):
    """Yields for each episode whether the agent learns in it, and whether it is the last one.

    `steps` has the number of steps of each episode that was played.
    """
    while sum(steps) < options.steps if options.steps else len(steps) < options.training:
        yield True, not options.evaluation and not options.steps and len(steps) == options.training - 1
    for remaining in reversed(range(options.evaluation)):
        yield False, remaining == 0


def value_or(value, default):
    """Returns `value`, or `default` if `value` is None."""
    return default if value is None else value


def read_options():
    """Reads the options of the command line, and checks them."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("server", help="the program racebeam, or the address of a server, such as tcp://HOST:PORT")
    parser.add_argument("game", nargs="?", default="beamfall", help="a game (default: %(default)s)")
    parser.add_argument("--training", type=int, help="episodes with learning (default: 20, with --play 0)")
    parser.add_argument(
        "--steps",
        type=int,
        help="steps of the agent that learns, of 5 frames each, in place of --training; the episode that reaches "
        "them is played to its end",
    )
    parser.add_argument(
        "--evaluation", type=int, help="episodes after it, without learning (default: 0, with --play 1)"
    )
    parser.add_argument(
        "--agent-seed", type=int, default=1, help="seed of the agent's random numbers (default: %(default)s)"
    )
    parser.add_argument(
        "--seed", type=int, default=1, help="seed of the first episode; they count up (default: %(default)s)"
    )
    parser.add_argument("--frames", type=int, default=18000, help="limit of frames per episode (default: %(default)s)")
    parser.add_argument(
        "--background", help="a CSV file of 210 lines of 160 colours (racebeam background); without it: black"
    )
    parser.add_argument("--actions", action="store_true", help="print the actions of each episode")
    parser.add_argument("--curve", metavar="FILE", help="a PNG of the scores, beside that of random play")
    parser.add_argument("--keep", metavar="FILE", help="the file for what was learned, at the end")
    parser.add_argument(
        "--play",
        metavar="FILE",
        help="begin with what this file has, and only play unless --training or --steps is given",
    )
    parser.add_argument(
        "--film", metavar="NAME", help="record the last episode as NAME.gif, in the folder of a server if it has one"
    )
    parser.add_argument("--log", metavar="FILE", help="the log of the last episode, FILE.episode")
    options = parser.parse_args()
    options.training = value_or(options.training, 0 if options.play else 20)
    options.evaluation = value_or(options.evaluation, 1 if options.play else 0)
    if not (options.steps or options.training or options.evaluation):
        parser.error("--training and --evaluation are 0; one of them must be 1 or more")
    if options.film and options.steps and not options.evaluation:
        parser.error("--film is given with --steps; it takes --evaluation 1 or more, and films the last of these")
    return options


def background_of(options):
    """Returns the colours of the background."""
    if not options.background:
        return np.zeros(WIDTH * HEIGHT, np.uint8)
    try:
        return np.loadtxt(options.background, np.uint8, delimiter=",").reshape(WIDTH * HEIGHT)
    except (OSError, ValueError) as error:
        sys.exit(f"sarsa.py: --background is {options.background!r}: {error}; it takes 210 lines of 160 colours")


def agent_of(options):
    """Makes the agent. With --play, it has the weights in that file."""
    agent = Sarsa(Basic.SIZE, options.agent_seed)
    if options.play:
        try:
            agent.restore(options.play)
        except (OSError, ValueError, KeyError) as error:
            sys.exit(f"sarsa.py: --play is {options.play!r}: {error}; it takes a file of --keep")
    return agent


def open_session(server):
    """Starts the program, or connects to the address of a server."""
    try:
        return connect(server) if ":" in server else Session.start(server, "--record-dir", ".")
    except (OSError, ValueError, Refused) as error:
        sys.exit(f"sarsa.py: no server at {server}: {error}")


def play_all(session, agent, basic, options):
    """Plays the episodes. Returns the steps and the score of each, and the actions of the last one."""
    start, steps, scores, actions = time.monotonic(), [], [], []
    with Progress(options) as progress:
        for agent.learning, is_last in schedule(options, steps):  # the schedule reads `steps`
            load = load_of(options, options.seed + len(steps))
            score, actions = play(session, agent, basic, load, options.film if is_last else None)
            steps.append(len(actions))
            scores.append(score)
            kind = "training" if agent.learning else "evaluation"
            words = [f"{kind} episode {len(steps)}: score {score} in {len(actions)} decisions"]
            progress.print(" ".join([*words, *map(str, actions if options.actions else [])]), len(actions))
    print(f"{sum(steps) / (time.monotonic() - start):.0f} decisions a second", file=sys.stderr)
    return steps, scores, actions


def main():
    """Reads the options, then learns and plays as they say."""
    options = read_options()
    agent, basic = agent_of(options), Basic(background_of(options))
    with open_session(options.server) as session:
        print_plan(session, basic, options)
        steps, scores, actions = play_all(session, agent, basic, options)
        if options.curve:
            title = f"SARSA on {options.game}"
            draw(options.curve, np.cumsum(steps), scores, random_score(session, options), title)
    if options.keep:
        agent.keep(options.keep)
    if options.log:
        write_log(options, options.seed + len(steps) - 1, actions)


if __name__ == "__main__":
    try:
        main()
    except (OSError, ValueError, Refused) as error:
        sys.exit(f"sarsa.py: {error}")
