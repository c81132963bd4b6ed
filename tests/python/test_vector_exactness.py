"""racebeam's AtariVectorEnv is equal to ale_py's in all games: observations, rewards and infos, step by step.

The settings take turns: the defaults, those that change the most, and drawn ones. The test plays a run of a quarter of
the games, with others, and other settings and seeds, each day. scripts/check/python-exactness plays all.

The reference's queue loses a machine now and then, and its recv() then waits for ever. Each run is therefore a process,
which has --patience seconds.
"""

import argparse
import contextlib
import datetime
import itertools
import mmap
import os
import random
import signal
import sys
import threading

import package
import pytest

package.require("ale_py", "gymnasium", "numpy")

import ale_py
import numpy as np
from ale_py.vector_env import AtariVectorEnv as Reference
from gymnasium.vector import AutoresetMode
from racebeam.ale_py.vector_env import AtariVectorEnv

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("--steps", type=int, default=40, help="steps per run (default 40)")
parser.add_argument("--runs", type=int, default=1, help="runs of each game (default 1)")
parser.add_argument("--envs", type=int, default=3, help="environments per run (default 3)")
parser.add_argument(
    "--first", type=int, default=datetime.date.today().toordinal(), help="number of the first run (default: of the day)"
)
parser.add_argument("--defaults", action="store_true", help="only in the default settings")
parser.add_argument("--games", help="A,B: only these")
parser.add_argument(
    "--parts", type=int, default=4, help="number of parts of the games; one part is played, by --first (default 4)"
)
parser.add_argument("--patience", type=float, default=120, help="seconds of a run at most (default 120)")
options = parser.parse_args([])

ale_py.ALEInterface.setLoggerMode(ale_py.LoggerMode.Error)
WITHOUT_SCORE = ("combat", "joust", "maze_craze", "warlords")  # ale_py registers no id for them
# Settings in which the reference never comes back: video_cube's reset (tests/conformance/not_comparable.py), and the
# first step of lost_luggage with the seed that was tried (739943059).
NEVER_BACK = {"video_cube": "max_num_frames_per_episode", "lost_luggage": "continuous"}
SHORT = {"max_num_frames_per_episode": 90}
SETTINGS = (
    {},
    {"repeat_action_probability": 0.25, "frameskip": 5, "reward_clipping": False, "full_action_space": True},
    {"grayscale": False, "img_height": 60, "img_width": 100, "stack_num": 2, "episodic_life": True},
    {"autoreset_mode": AutoresetMode.SAME_STEP, "maxpool": False, **SHORT},
    {"continuous": True, "continuous_action_threshold": 0.3, "life_loss_info": True, "noop_max": 3},
    {"use_fire_reset": False, "noop_max": 0, "img_height": 105, "img_width": 160, "stack_num": 1, **SHORT},
    {
        "autoreset_mode": AutoresetMode.SAME_STEP,
        "episodic_life": True,
        "frameskip": 9,
        "repeat_action_probability": 0.25,
    },
    {"img_height": 105, "img_width": 80, "stack_num": 1, **SHORT},
    {"img_height": 42, "img_width": 40, "stack_num": 1, "grayscale": False, **SHORT},
    {"img_height": 224, "img_width": 224, "stack_num": 1, "grayscale": False},
    {"img_height": 100, "img_width": 320, "stack_num": 2},
    None,  # drawn
)
DRAWN = {
    "num_threads": range(1, 5),
    "repeat_action_probability": (0.1, 0.25, 1.0),
    "frameskip": (1, 2, 3, 5, 8, 30),
    "grayscale": (False,),
    "img_height": range(9, 420),
    "img_width": range(1, 321),
    "stack_num": range(1, 9),
    "maxpool": (False,),
    "noop_max": (0, 1, 2, 31, 60),
    "use_fire_reset": (False,),
    "episodic_life": (True,),
    "reward_clipping": (False,),
    "full_action_space": (True,),
    "max_num_frames_per_episode": range(1, 600),
    "autoreset_mode": (AutoresetMode.SAME_STEP,),
}


class Different(Exception):
    pass


def compare(what, ours, theirs):
    if type(ours) is not type(theirs) or ours.dtype != theirs.dtype:
        raise Different(f"{what}: the types are {type(ours)} and {type(theirs)}")
    if not np.array_equal(ours, theirs):
        raise Different(f"{what}: {np.count_nonzero(ours != theirs)} elements of {ours.size}")


def compare_infos(where, ours, theirs, ended):
    if set(ours) != set(theirs):
        raise Different(f"{where}: the keys are {list(ours)} and {list(theirs)}")
    for key in theirs:
        chosen = ended if key == "final_obs" else slice(None)  # the reference leaves the others to chance
        compare(f"{where}: {key}", ours[key][chosen], theirs[key][chosen])


def compare_spaces(ours, theirs):
    for name in ("single_observation_space", "single_action_space", "observation_space", "action_space"):
        if getattr(ours, name) != getattr(theirs, name):
            raise Different(name)


def play(game, seed, settings):
    """How many episodes ended."""
    ours = AtariVectorEnv(game, options.envs, **settings)
    with awaiting_the_reference():
        theirs = Reference(game, options.envs, **settings)
    compare_spaces(ours, theirs)
    ours.action_space.seed(seed)
    result = ours.reset(seed=seed)
    with awaiting_the_reference():
        expected = theirs.reset(seed=seed)
    compare("reset: seen", result[0], expected[0])
    compare_infos("reset", result[1], expected[1], ())
    episodes = 0
    for step in range(options.steps):
        actions = ours.action_space.sample()
        result = ours.step(actions)
        with awaiting_the_reference():
            expected = theirs.step(actions)
        for name, one, other in zip(("seen", "rewards", "terminated", "truncated"), result, expected):
            compare(f"step {step}: {name}", one, other)
        ends = np.flatnonzero(expected[2] | expected[3])
        compare_infos(f"step {step}", result[4], expected[4], ends)
        episodes += len(ends)
    ours.close()
    return episodes


awaits_the_reference = mmap.mmap(-1, 1)  # shared with the process of a run


@contextlib.contextmanager
def awaiting_the_reference():
    awaits_the_reference[0] = 1
    yield
    awaits_the_reference[0] = 0


def play_apart(game, seed, settings):
    """How many episodes ended, in its own process. Raises Different, and TimeoutError after options.patience."""
    awaits_the_reference[0] = 0
    reader, writer = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            outcome = str(play(game, seed, settings))
        except BaseException as error:
            outcome = f"{type(error).__name__}: {error}"
        os.write(writer, outcome.encode())
        os._exit(0)  # the reference's threads may never end
    os.close(writer)
    killer = threading.Timer(options.patience, os.kill, (child, signal.SIGKILL))
    killer.start()
    with open(reader, encoding="utf-8") as pipe:
        outcome = pipe.read()
    killer.cancel()
    _, status = os.waitpid(child, 0)
    if os.WIFSIGNALED(status) and os.WTERMSIG(status) == signal.SIGKILL:
        raise TimeoutError
    if not outcome:
        raise Different(f"the process ended with the wait status {status}")
    if not outcome.isdecimal():
        raise Different(outcome)
    return int(outcome)


def settings_of(turn, seed):
    settings = SETTINGS[0 if options.defaults else turn % len(SETTINGS)]
    if settings is not None:
        return settings
    chance = random.Random(seed)
    return {name: chance.choice(values) for name, values in DRAWN.items() if chance.random() < 0.5}


def runs():
    """The runs of a part: game, seed and settings."""
    games = (
        options.games.split(",") if options.games else [game for game in package.roms() if game not in WITHOUT_SCORE]
    )
    indices = range(len(games)) if options.games else range(options.first % options.parts, len(games), options.parts)
    for number, run in itertools.product(indices, range(options.first, options.first + options.runs)):
        seed = 1000 * run + number
        settings = settings_of(number + run, seed)
        yield games[number], seed, SETTINGS[0] if NEVER_BACK.get(games[number]) in settings else settings


def differences():
    """Plays the runs of a part. Returns a line for each that differs, the number of runs, the number of episodes that
    ended, and the number of runs in which the reference did not come back."""
    found, count, ended, never_back = [], 0, 0, 0
    for game, seed, settings in runs():
        count += 1
        try:
            ended += play_apart(game, seed, settings)
        except Different as difference:
            found.append(f"{game}, seed {seed}, {settings}: {difference}")
        except TimeoutError:
            if awaits_the_reference[0]:
                never_back += 1
                print(f"the reference did not come back: {game}, seed {seed}, {settings}", flush=True)
            else:
                found.append(f"{game}, seed {seed}, {settings}: racebeam did not come back")
    return found, count, ended, never_back


def compares_too_little(count, never_back):
    return never_back > max(1, count // 100)


@pytest.mark.slow
@pytest.mark.needs_roms
def test_no_run_of_today_differs():
    found, count, _, never_back = differences()
    assert count
    assert found == []
    assert not compares_too_little(count, never_back)


if __name__ == "__main__":
    options = parser.parse_args()
    found, count, ended, never_back = differences()
    print(*(f"FAILED: {line}" for line in found), sep="\n")
    print(f"{count} runs, {ended} episodes that ended: {len(found)} differ; {never_back} without the reference")
    sys.exit(bool(found) or not count or compares_too_little(count, never_back))
