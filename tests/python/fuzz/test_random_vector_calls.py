"""AtariVectorEnv, made and called with random arguments, many of them senseless: each call returns or raises what is
documented."""

import random

import package
import pytest

package.require("numpy", "gymnasium")

import numpy as np
import racebeam
from gymnasium.error import Error
from racebeam import AtariVectorEnv

CALLS = 1500
SEEDS = range(1, 25)  # scripts/check/python-fuzz draws others each time

DOCUMENTED = (TypeError, IndexError, racebeam.InvalidInput, Error)
chance = random.Random()

# Sensible values of the arguments, so that most environments can be made.
ARGUMENTS = {
    "num_envs": (1, 2, 3),
    "batch_size": (0, 1, 2),
    "num_threads": (0, 1, 2),
    "frameskip": (1, 4),
    "stack_num": (1, 2, 4),
    "noop_max": (0, 5),
    "img_height": (9, 84, 210),
    "img_width": (1, 84, 160),
    "grayscale": (True, False),
    "maxpool": (True, False),
    "continuous": (True, False),
    "autoreset_mode": ("NextStep", "SameStep", "Disabled"),
    "lives": ("ignored", "reported", "end", "restart"),
    "preset": ("ale", "dqn2015"),
    "start": ("fire-noops", "noops-fire", "baselines"),
    "stack_start": ("zeros", "repeats"),
    "obs_type": (None, "ram", "rgb", "grayscale"),
    "max_num_frames_per_episode": (0, 9, 40),
    "render_mode": (None, "rgb_array"),
    "seed": (None, 0, 7),
    "full_action_space": (True, False),
}
SENSELESS = [
    0,
    1,
    -1,
    99,
    2**31,
    2**63,
    -(2**70),
    0.5,
    float("nan"),
    "",
    "FIRE",
    b"xx",
    None,
    True,
    (),
    [1],
    {},
    np.int64(3),
    np.float32(0.5),
    np.zeros(2, int),
    np.zeros((2, 3)),
    np.full((2, 3), np.nan, np.float32),
    np.zeros((0,), int),
    np.zeros((2, 4, 84, 84), np.uint8),
    np.ones(2, bool),
    {"reset_mask": np.ones(2, bool)},
    {"reset_mask": 3},
    [[1], [2, 3]],
]


def make():
    """New environments, with an argument in five senseless."""
    settings = {name: chance.choice(values) for name, values in ARGUMENTS.items() if chance.random() < 0.4}
    if chance.random() < 0.2:
        settings[chance.choice(list(ARGUMENTS))] = chance.choice(SENSELESS)
    return AtariVectorEnv(chance.choice(["beamfall", "updraft"]), **settings)


def sensible_call(envs, states):
    """A method, and arguments that it takes."""
    calls = [
        ("step", [envs.action_space.sample()]),
        ("send", [envs.action_space.sample()]),
        ("recv", []),
        ("reset", []),
        ("show", []),
        ("render", []),
        ("save", [chance.randrange(envs.num_envs)]),
    ]
    if states:
        calls.append(("restore", [chance.randrange(envs.num_envs), chance.choice(states)]))
    return chance.choice(calls)


def run():
    """How many calls returned, and how many were refused."""
    returned = refusals = 0
    envs, states = None, []
    for _ in range(CALLS):
        try:
            if envs is None or chance.random() < 0.03:
                envs = make()
            method, arguments = sensible_call(envs, states)
            keywords = {}
            if chance.random() < 0.3:
                arguments = [chance.choice(SENSELESS) for _ in arguments]
                keywords = {
                    name: chance.choice(SENSELESS)
                    for name in ("seed", "options", "out")
                    if method == "reset" and chance.random() < 0.5
                }
            value = getattr(envs, method)(*arguments, **keywords)
            returned += 1
        except DOCUMENTED:
            refusals += 1
            continue
        if method == "save":
            states = [*states[-8:], value]
    return returned, refusals


@pytest.mark.slow
@pytest.mark.parametrize("seed", SEEDS)
def test_each_call_returns_or_is_refused(seed):
    chance.seed(seed)
    returned, refused = run()
    assert returned
    assert refused
