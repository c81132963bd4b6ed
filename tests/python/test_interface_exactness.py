"""racebeam.ale_py's ALEInterface is equal to ale_py's: the same random calls have the same outcome.

A run loads one of two images again and again, and changes the mode, the difficulty, RAM, and the strength of the
paddles. Half of the runs clone and restore states. The test compares all that the interface shows after each call. The
runs follow each other in one process, so that they also compare what machines of one image share, such as resets. The
test plays other runs each day. scripts/check/python-exactness plays more.

The test leaves out three of the differences that racebeam.ale_py lists:

- A state has the sticky action of its moment. Before each clone and each restoration, the run plays no-ops.
- A state has the picture and the sound. After a restoration, the test compares neither until the next image.
- A state has an open frame. Only a game whose RAM was changed ends acts in one, so runs with states change none.
"""

import argparse
import datetime
import pickle
import random
import sys

import differing_runs
import package
import pytest

package.require("ale_py", "gymnasium", "numpy")

import ale_py
import numpy as np
import racebeam
import racebeam.ale_py as drop_in

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("--calls", type=int, default=60, help="calls per run (default 60)")
parser.add_argument("--runs", type=int, default=24, help="number of runs (default 24)")
parser.add_argument(
    "--first",
    type=int,
    default=1000 * datetime.date.today().toordinal(),
    help="number of the first run (default: of the day)",
)
options = parser.parse_args([])

ale_py.ALEInterface.setLoggerMode(ale_py.LoggerMode.Error)
WITHOUT_SCORE = ("combat", "joust", "maze_craze", "warlords")  # ale_py ends the process
# Their modes are set up by acts. The reference never comes back if a limit of frames has ended the episode before.
ACT_AT_RESETS = ("adventure", "berzerk", "double_dunk", "video_cube")
# Its lives have no value before they are first set (docs/spec/environment.md, 5).
NO_LIVES_AT_FIRST = ("atlantis2",)
RUNS_OF_A_PAIR = 6  # of games
STICKY = 0.25
NOOPS = 14  # after which the held action is NOOP, except in one of 10^8 cases


class Different(Exception):
    pass


def chance_of(*words):
    return random.Random(" ".join(map(str, words)))


def games_of(number):
    games = [game for game in package.roms() if game not in WITHOUT_SCORE]
    return chance_of("games", number // RUNS_OF_A_PAIR).sample(games, 2)


def settings_of(chance, games):
    """(setter, key, value) of the settings of a run. A third of the rarer ones is set."""
    drawn = [
        ("setInt", "random_seed", chance.choice([0, 1, -2, -(2**31), 2**31 - 1])),
        ("setInt", "frame_skip", chance.choice([1, 1, 2, 5])),
        ("setFloat", "repeat_action_probability", chance.choice([0.0, STICKY])),
        ("setBool", "sound_obs", True),
    ]
    others = [
        ("setInt", "system_random_seed", chance.randrange(3)),
        ("setBool", "color_averaging", True),
        ("setInt", "reward_min", chance.choice([-1, 0])),
        ("setInt", "reward_max", chance.choice([1, 7])),
        ("setInt", "paddle_min", chance.randrange(300_000)),
        ("setInt", "paddle_max", chance.randrange(500_000, 900_000)),
    ]
    if not set(games) & set(ACT_AT_RESETS):
        others.append(("setInt", "max_num_frames_per_episode", chance.randrange(1, 100)))
    if not set(games) & set(NO_LIVES_AT_FIRST):
        others.append(("setBool", "truncate_on_loss_of_life", True))
    return drawn + [setting for setting in others if chance.random() < 1 / 3]


def calls_of(chance, games, calls):
    """(method of Player, its arguments) of the calls of a run, which begins with an image."""
    yield "load", chance.choice(games)
    with_states, clones, action = chance.random() < 0.5, 0, 0
    for _ in range(calls):
        kind = chance.random()
        if kind < 0.6:
            action = chance.choice([action, chance.randrange(18)])
            yield "act", action, chance.choice([1.0, 1.0, 0.5, -0.25, chance.uniform(-2, 2)])
        elif kind < 0.7:
            yield ("reset",)
        elif kind < 0.76:
            yield "mode", chance.random()
        elif kind < 0.82:
            yield "difficulty", chance.random()
        elif kind < 0.85:
            yield "load", chance.choice(games)
            clones = 0
        elif not with_states:
            yield "write", chance.randrange(128), chance.randrange(256)
        else:
            for _ in range(NOOPS):
                yield "act", 0, 1.0
            if clones and chance.random() < 0.6:
                yield "restore", chance.randrange(clones), chance.choice(["restoreState", "restoreSystemState"])
            else:
                yield "clone", chance.choice([{}, {"include_rng": True}, None]), chance.random() < 0.5
                clones += 1


class Player:
    """An ALEInterface of one of the packages. Each call returns what it says."""

    def __init__(self, module, settings):
        self.ale, self.states, self.restored = module.ALEInterface(), [], False
        for setter, key, value in settings:
            getattr(self.ale, setter)(key, value)

    def load(self, game):
        self.ale.loadROM(racebeam.find_image(game))
        self.states, self.restored = [], False
        return self.ale.getScreenDims()

    def act(self, action, strength):
        return self.ale.act(action, strength)

    def reset(self):
        self.ale.reset_game()

    def mode(self, share):
        self.ale.setMode(chosen(self.ale.getAvailableModes(), share))

    def difficulty(self, share):
        self.ale.setDifficulty(chosen(self.ale.getAvailableDifficulties(), share))

    def write(self, index, value):
        self.ale.setRAM(index, value)

    def clone(self, arguments, pickled):
        state = self.ale.cloneSystemState() if arguments is None else self.ale.cloneState(**arguments)
        self.states.append(pickle.loads(pickle.dumps(state)) if pickled else state)
        return state.getFrameNumber(), state.getEpisodeFrameNumber(), state.getDifficulty(), state.getCurrentMode()

    def restore(self, number, method):
        getattr(self.ale, method)(self.states[number])
        self.restored = True

    def seen(self):
        ale = self.ale
        yield "ram", ale.getRAM()
        yield "lives", ale.lives()
        yield "ends", (ale.game_over(), ale.game_over(with_truncation=False), ale.game_truncated())
        yield "frames", (ale.getFrameNumber(), ale.getEpisodeFrameNumber())
        if not self.restored:
            yield "screen", ale.getScreen()
            yield "rgb", ale.getScreenRGB()
            yield "grey", ale.getScreenGrayscale()
            yield "sound", ale.getAudio()


def chosen(values, share):
    values = sorted(values)
    return values[int(share * len(values))]


def compare(where, ours, theirs):
    if isinstance(theirs, np.ndarray):
        if not np.array_equal(ours, theirs):
            raise Different(f"{where}: {np.count_nonzero(ours != theirs)} elements of {ours.size}")
    elif ours != theirs:
        raise Different(f"{where}: {ours} and {theirs}")


def play(number, calls):
    chance, games = chance_of("run", number), games_of(number)
    settings = settings_of(chance, games)
    ours, theirs = players = [Player(module, settings) for module in (drop_in, ale_py)]
    for count, (method, *arguments) in enumerate(calls_of(chance, games, calls)):
        where = f"{' and '.join(games)}, call {count}, {method}{tuple(arguments)}"
        compare(where, *(getattr(player, method)(*arguments) for player in players))
        for (name, one), (_, other) in zip(ours.seen(), theirs.seen()):
            compare(f"{where}: {name}", one, other)


def differences():
    """Plays the runs. Returns a line for each that differs, and the number of runs."""
    found = []
    for number in range(options.first, options.first + options.runs):
        try:
            play(number, options.calls)
        except Different as difference:
            found.append(f"--first {number}: {difference}")
    return found, options.runs


@pytest.mark.slow
@pytest.mark.needs_roms
def test_no_run_of_today_differs():
    differing_runs.check(*differences())


if __name__ == "__main__":
    options = parser.parse_args()
    sys.exit(differing_runs.report(*differences()))
