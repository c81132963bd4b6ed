#!/usr/bin/env python3
"""SARSA(lambda) with Basic features (Bellemare et al. 2013): an agent that learns a game over the line protocol.

It needs NumPy, and Matplotlib for --curve. With the same seeds, it chooses what the agent `basic` of
`racebeam experiment` chooses.
"""

import argparse
import pathlib
import sys
import time

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "single_file"))
from client import Refused, Session, connect  # noqa: E402

ACTIONS = 18
WIDTH, HEIGHT, COLOURS = 160, 210, 128
TILE_WIDTH, TILE_HEIGHT = 10, 15  # pixels; 16 x 14 tiles
STEP_SIZE = 0.5  # alpha, divided by the largest number of active features so far
DISCOUNT, DECAY = 0.999, 0.9  # gamma, lambda
EXPLORATION = 0.05  # epsilon, in evaluation too
LEAST_TRACE = np.float32(0.01)  # smaller traces are dropped


class Random:
    """SplitMix64 (Steele, Lea and Flood 2014)."""

    def __init__(self, seed):
        self.state = seed

    def next(self):
        self.state = z = (self.state + 0x9E3779B97F4A7C15) % 2**64
        z = (z ^ z >> 30) * 0xBF58476D1CE4E5B9 % 2**64
        z = (z ^ z >> 27) * 0x94D049BB133111EB % 2**64
        return z ^ z >> 31

    def below(self, count):
        number = self.next()
        while number < 2**64 % count:  # each remainder is to be as likely
            number = self.next()
        return number % count

    def uniform(self):
        return (self.next() >> 11) / 2**53


class Basic:
    """A feature for each colour in each tile of the screen that is not the background's at its pixel."""

    SIZE = WIDTH // TILE_WIDTH * (HEIGHT // TILE_HEIGHT) * COLOURS

    def __init__(self, background):
        self.background = background
        rows, columns = np.arange(HEIGHT) // TILE_HEIGHT, np.arange(WIDTH) // TILE_WIDTH
        self.first = (
            (rows[:, None] * (WIDTH // TILE_WIDTH) + columns) * COLOURS
        ).ravel()  # feature of each pixel's tile

    def active(self, screen):
        """The features of a screen of palette indices, in ascending order. Rows that are missing are black."""
        colours = np.zeros(WIDTH * HEIGHT, np.uint8)
        pixels = np.frombuffer(screen, np.uint8)[: WIDTH * HEIGHT]
        colours[: len(pixels)] = pixels >> 1
        changed = np.flatnonzero(colours != self.background)
        return np.unique(self.first[changed] + colours[changed])


class Sarsa:
    """Linear SARSA with replacing traces, one for each feature and action."""

    def __init__(self, features, seed):
        self.weights = np.zeros((features, ACTIONS), np.float32)
        self.traces, self.live = (
            np.zeros(features * ACTIONS, np.float32),
            np.empty(0, np.intp),
        )  # live: where they are not 0
        self.most_active, self.first_reward = 1, 0.0
        self.random, self.learning = Random(seed), True

    def keep(self, path):
        """Writes what was learned into a file."""
        with open(path, "wb") as file:
            np.savez_compressed(file, weights=self.weights, learned=[self.most_active, self.first_reward])

    def restore(self, path):
        """Reads a file of keep()."""
        with np.load(path) as file:
            weights, (self.most_active, self.first_reward) = file["weights"], file["learned"].tolist()
        if weights.shape != self.weights.shape:
            raise ValueError(f"its weights have the shape {weights.shape}, not {self.weights.shape}")
        self.weights = weights

    def begin(self, features):
        self.traces[self.live] = 0
        self.live = np.empty(0, np.intp)
        return self.choose(features, self.values(features))

    def next(self, reward, features):
        before, scaled = self.value_before(), self.scaled(reward)
        values = self.values(features)
        taken, active = self.action, self.features
        action = self.choose(features, values)
        self.learn(active, taken, scaled + DISCOUNT * float(values[action]) - before)
        return action

    def end(self, reward):
        before, scaled = self.value_before(), self.scaled(reward)
        self.learn(self.features, self.action, scaled - before)

    def values(self, features):
        """Of all actions. The sums are in the features' order, so that they are the same everywhere."""
        return np.cumsum(self.weights[features], axis=0, dtype=float)[-1] if len(features) else np.zeros(ACTIONS)

    def value_before(self):
        return float(self.values(self.features)[self.action])

    def choose(self, features, values):
        if self.random.uniform() < EXPLORATION:
            action = self.random.below(ACTIONS)
        else:
            best = np.flatnonzero(values == values.max())
            action = int(best[0 if len(best) == 1 else self.random.below(len(best))])
        self.features, self.action = features, action
        return action

    def scaled(self, reward):
        """The reward, divided by the size of the first one that is not 0."""
        self.first_reward = self.first_reward or abs(reward)
        return reward / self.first_reward if reward else 0.0

    def learn(self, active, taken, error):
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
    session.observe("reward", "ends", "screen:zlib")
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


def draw(path, scores, title):
    """The scores as a picture, and their mean over the last 5 episodes."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    episodes = range(1, len(scores) + 1)
    pyplot.figure(figsize=(6, 4))
    pyplot.plot(episodes, scores, ".", episodes, [np.mean(scores[max(0, end - 5) : end]) for end in episodes], "-")
    pyplot.xlabel("episode")
    pyplot.ylabel("score")
    pyplot.title(title)
    pyplot.savefig(path, dpi=120)


def show_progress(done, total, start):
    """Shows how far the program is, and how long it still takes, if a person looks on."""
    if sys.stderr.isatty():
        left = (time.monotonic() - start) * (total - done) / done
        print(
            f"\r[{'#' * (30 * done // total):30}] {done} of {total} episodes, {left:.0f} s left ",
            end="",
            file=sys.stderr,
        )
        print(end="\n" if done == total else "", file=sys.stderr, flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("server", help="the program racebeam, or the address of a server, such as tcp://HOST:PORT")
    parser.add_argument("game", nargs="?", default="beamfall", help="(default: %(default)s)")
    parser.add_argument("--training", type=int, default=20, help="episodes (default: %(default)s)")
    parser.add_argument(
        "--evaluation", type=int, default=0, help="episodes after it, without learning (default: %(default)s)"
    )
    parser.add_argument("--agent-seed", type=int, default=1, help="(default: %(default)s)")
    parser.add_argument(
        "--seed", type=int, default=1, help="of the first episode; they count up (default: %(default)s)"
    )
    parser.add_argument("--frames", type=int, default=18000, help="of an episode at most (default: %(default)s)")
    parser.add_argument(
        "--background", help="a CSV file of 210 lines of 160 colours (racebeam background); without it: black"
    )
    parser.add_argument("--actions", action="store_true", help="print the actions of each episode")
    parser.add_argument("--curve", metavar="FILE", help="a PNG of the scores")
    parser.add_argument("--keep", metavar="FILE", help="the file for what was learned, at the end")
    parser.add_argument("--play", metavar="FILE", help="begin with what this file has; --training 0 only plays")
    parser.add_argument(
        "--film", metavar="NAME", help="record the last episode as NAME.gif, in the folder of a server if it has one"
    )
    options = parser.parse_args()
    episodes = options.training + options.evaluation
    background = np.zeros(WIDTH * HEIGHT, np.uint8)
    if options.background:
        try:
            background = np.loadtxt(options.background, np.uint8, delimiter=",").reshape(WIDTH * HEIGHT)
        except (OSError, ValueError) as error:
            sys.exit(f"sarsa.py: --background is {options.background!r}: {error}; it takes 210 lines of 160 colours")
    agent, basic = Sarsa(Basic.SIZE, options.agent_seed), Basic(background)
    if options.play:
        try:
            agent.restore(options.play)
        except (OSError, ValueError, KeyError) as error:
            sys.exit(f"sarsa.py: --play is {options.play!r}: {error}; it takes a file of --keep")
    try:
        opened = (
            connect(options.server) if ":" in options.server else Session.start(options.server, "--record-dir", ".")
        )
    except (OSError, ValueError, Refused) as error:
        sys.exit(f"sarsa.py: no server at {options.server}: {error}")
    print(
        f"plan: {options.training} episodes with learning and {options.evaluation} without, "
        f"of {options.frames:,} frames at most",
        file=sys.stderr,
    )
    start, decisions, scores = time.monotonic(), 0, []
    with opened as session:
        for episode in range(episodes):
            agent.learning = episode < options.training
            film = options.film if episode == episodes - 1 else None
            score, actions = play(
                session,
                agent,
                basic,
                {
                    "game": options.game,
                    "preset": "paper2013",
                    "seed": options.seed + episode,
                    "max_episode_frames": options.frames,
                },
                film,
            )
            decisions += len(actions)
            scores.append(score)
            kind = "training" if agent.learning else "evaluation"
            print(
                kind,
                f"episode {episode + 1}: score {score} in {len(actions)} decisions",
                *actions if options.actions else [],
            )
            show_progress(episode + 1, episodes, start)
    if options.keep:
        agent.keep(options.keep)
    print(f"{decisions / (time.monotonic() - start):.0f} decisions a second", file=sys.stderr)
    if options.curve:
        draw(options.curve, scores, f"SARSA on {options.game}")


if __name__ == "__main__":
    try:
        main()
    except (OSError, Refused) as error:
        sys.exit(f"sarsa.py: {error}")
