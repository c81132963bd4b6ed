"""racebeam's AtariEnv is equal to ale_py's in all games: observations, rewards and infos, step by step.

The test compares all kinds of observation at each step. Where an episode ends, the next one begins without a seed, so
that the generators have to agree, too. The settings take turns: the defaults, and those that change the most. The test
plays a run of half the games, with others, and other settings and seeds, each day. scripts/check/python-exactness plays
all.
"""

import argparse
import datetime
import itertools
import sys

import differing_runs
import package
import pytest

package.require("ale_py", "gymnasium", "numpy")

import ale_py
import numpy as np
import racebeam

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("--steps", type=int, default=40, help="steps per run (default 40)")
parser.add_argument("--runs", type=int, default=1, help="runs of each game (default 1)")
parser.add_argument(
    "--first", type=int, default=datetime.date.today().toordinal(), help="number of the first run (default: of the day)"
)
parser.add_argument("--defaults", action="store_true", help="only in the default settings")
parser.add_argument("--games", help="A,B: only these")
parser.add_argument(
    "--parts", type=int, default=2, help="number of parts of the games; one part is played, by --first (default 2)"
)
options = parser.parse_args([])

ale_py.ALEInterface.setLoggerMode(ale_py.LoggerMode.Error)
WITHOUT_SCORE = ("combat", "joust", "maze_craze", "warlords")  # ale_py registers no id for them
SETTINGS = (
    {},
    {"obs_type": "ram", "full_action_space": True, "repeat_action_probability": 0.5, "frameskip": (2, 5)},
    {"obs_type": "grayscale", "repeat_action_probability": 0.0, "max_num_frames_per_episode": 90},
    {"sound_obs": True, "frameskip": 3},
    {"continuous": True, "continuous_action_threshold": 0.3},
)


def parts(env, observation):
    ale = env.ale
    parts = observation if isinstance(observation, dict) else {"observation": observation}
    return {
        **parts,
        "ram": ale.getRAM(),
        "grey": ale.getScreenGrayscale(),
        "rgb": ale.getScreenRGB(),
        "palette": ale.getScreen(),
    }


class Different(Exception):
    pass


def compare(what, ours, theirs):
    if type(ours) is not type(theirs):
        raise Different(f"{what}: the types are {type(ours)} and {type(theirs)}")
    if isinstance(ours, dict):
        if list(ours) != list(theirs):
            raise Different(f"{what}: the keys are {list(ours)} and {list(theirs)}")
        for key in ours:
            compare(f"{what}[{key}]", ours[key], theirs[key])
    elif isinstance(ours, np.ndarray):
        if ours.dtype != theirs.dtype or ours.shape != theirs.shape or not np.array_equal(ours, theirs):
            raise Different(f"{what}: {np.count_nonzero(ours != theirs)} elements of {ours.size}")
    elif ours != theirs:
        raise Different(f"{what}: {ours} and {theirs}")


def play(game, seed, settings):
    ours, theirs = racebeam.AtariEnv(game, **settings), ale_py.AtariEnv(game, **settings)
    if ours.action_space != theirs.action_space or ours.observation_space != theirs.observation_space:
        raise Different("the spaces")
    compare("meanings", ours.get_action_meanings(), theirs.get_action_meanings())
    ours.action_space.seed(seed)
    where = "reset with a seed"
    results = [env.reset(seed=seed) for env in (ours, theirs)]
    for step in range(options.steps + 1):
        compare(f"{where}: seen", parts(ours, results[0][0]), parts(theirs, results[1][0]))
        compare(f"{where}: told", results[0][1:], results[1][1:])
        if isinstance(results[0][-2], bool) and (results[0][2] or results[0][3]):
            where = f"reset at step {step}"
            results = [env.reset() for env in (ours, theirs)]
            continue
        action = ours.action_space.sample()
        where = f"step {step}"
        results = [env.step(action) for env in (ours, theirs)]


def settings_of(number, run):
    return SETTINGS[0 if options.defaults else (number + run) % len(SETTINGS)]


def runs():
    """The runs of a part: game, seed and settings."""
    games = (
        options.games.split(",") if options.games else [game for game in package.roms() if game not in WITHOUT_SCORE]
    )
    indices = range(len(games)) if options.games else range(options.first % options.parts, len(games), options.parts)
    for number, run in itertools.product(indices, range(options.first, options.first + options.runs)):
        settings = settings_of(number, run)
        if games[number] == "video_cube" and "max_num_frames_per_episode" in settings:
            settings = SETTINGS[0]  # the reference never comes back (tests/conformance/not_comparable.py)
        yield games[number], 1000 * run + number, settings


def differences():
    """Plays the runs of a part. Returns a line for each that differs, and the number of runs."""
    found, count = [], 0
    for game, seed, settings in runs():
        count += 1
        try:
            play(game, seed, settings)
        except Different as difference:
            found.append(f"{game}, seed {seed}, {settings}: {difference}")
    return found, count


@pytest.mark.slow
@pytest.mark.needs_roms
def test_no_run_of_today_differs():
    differing_runs.check(*differences())


if __name__ == "__main__":
    options = parser.parse_args()
    sys.exit(differing_runs.report(*differences()))
