"""Random methods with random arguments, many of them senseless: each call returns or raises a documented exception."""

import argparse
import os
import pickle
import random
import sys

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
import package

package.require("numpy")

import numpy as np
import racebeam
from racebeam._core import View

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("--calls", type=int, default=4000, help="calls per run (default 4000)")
parser.add_argument("--seed", type=int, default=1, help="seed of the first run; the next has one more (default 1)")
parser.add_argument("--runs", type=int, default=8, help="default 8; scripts/check/python-fuzz draws others each time")
options = parser.parse_args()

DOCUMENTED = (TypeError, racebeam.InvalidInput)
LONGEST = 1000  # frames of an act
KEYS = (
    "random_seed",
    "reward_min",
    "reward_max",
    "paddle_min",
    "paddle_max",
    "sound_obs",
    "rules",
    "max_num_frames_per_episode",
    "repeat_action_probability",
    "color_averaging",
    "truncate_on_loss_of_life",
)
VALUES = [
    0,
    1,
    -1,
    2,
    5,
    17,
    18,
    99,
    2**31 - 1,
    2**31,
    2**63,
    -(2**70),
    0.5,
    float("nan"),
    float("inf"),
    "FIRE",
    "",
    b"",
    b"xx",
    None,
    True,
    (),
    [1],
    {},
    np.int64(3),
    np.float32(0.5),
    "fixed",
    *KEYS,
    *racebeam.Action,
    *View,
    racebeam.ALEState(),
    np.zeros(128, np.uint8),
    np.zeros(512, np.uint8),
    np.zeros((210, 160), np.uint8),
    np.zeros((210, 160, 3), np.uint8),
    np.zeros((420, 160), np.uint8)[::2],
    np.zeros((210, 160), np.int32),
]

chance = random.Random()
METHODS = [name for name in dir(racebeam.ALEInterface) if not name.startswith("_") and name != "saveScreenPNG"]


def arguments_of(method, states):
    """Half of them sensible, so that games are played."""
    if chance.random() < 0.5:
        if method == "loadROM":
            return ["builtin:" + chance.choice(["beamfall", "updraft"])]
        if method == "step":
            return [chance.randrange(18), 1.0, chance.choice([1, 4, LONGEST]), chance.choice(list(View))]
        if method in ("restoreState", "restoreSystemState") and states:
            return [chance.choice(states)]
    return [chance.choice(VALUES) for _ in range(chance.choice([0, 0, 1, 1, 2, 2, 4]))]


def is_too_long(method, arguments):
    """Whether a step is too long for a test. Only an interrupt ends such a step, which test_threads.py tests."""
    return method == "step" and len(arguments) > 2 and isinstance(arguments[2], int) and arguments[2] > LONGEST


def run():
    """How many calls returned, and how many were refused."""
    ale, states = racebeam.ALEInterface(), []
    returned = refusals = 0
    for call in range(options.calls):
        method = chance.choice(METHODS)
        arguments = arguments_of(method, states)
        if is_too_long(method, arguments):
            continue
        try:
            value = getattr(ale, method)(*arguments)
            returned += 1
        except DOCUMENTED:
            refusals += 1
            continue
        if isinstance(value, racebeam.ALEState):
            states = [
                *states[-8:],
                chance.choice([value, racebeam.ALEState(value.serialize()), pickle.loads(pickle.dumps(value))]),
            ]
        if call % 50 == 0:
            ale = pickle.loads(pickle.dumps(ale))
    return returned, refusals


for seed in range(options.seed, options.seed + options.runs):
    chance.seed(seed)
    print(f"seed {seed}", flush=True)
    returned, refused = run()
    print(f"{returned} calls returned, {refused} were refused")
    if not returned or not refused:
        sys.exit(1)
