"""Random methods with random arguments, many of them senseless: each call returns or raises a documented exception."""

import pickle
import random

import package
import pytest

package.require("numpy")

import numpy as np
import racebeam
from racebeam._core import View

CALLS = 4000
SEEDS = range(1, 9)  # scripts/check/python-fuzz draws others each time

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
    for call in range(CALLS):
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


@pytest.mark.slow
@pytest.mark.parametrize("seed", SEEDS)
def test_each_call_returns_or_is_refused(seed):
    chance.seed(seed)
    returned, refused = run()
    assert returned
    assert refused
