"""What the tests of AtariVectorEnv share."""

import numpy as np

SHORT = {"max_num_frames_per_episode": 12, "noop_max": 0}  # three steps an episode


def play(envs, steps, seed=0):
    """What random actions show."""
    random = np.random.default_rng(seed)
    return [envs.step(random.integers(0, envs.single_action_space.n, envs.batch_size)) for _ in range(steps)]


def same(one, other):
    """Whether two lists of what was shown are equal, their infos included."""
    return all(
        np.array_equal(a, b)
        for found, expected in zip(one, other)
        for a, b in zip([*found[:-1], *found[-1].values()], [*expected[:-1], *expected[-1].values()])
    )
