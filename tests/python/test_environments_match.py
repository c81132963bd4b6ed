"""Gymnasium's check_environments_match finds no difference between ALE/Pong-v5 and racebeam/Pong-v5, nor for any other
game.

All games, kinds of observation and seeds take long: the test takes some each day. scripts/check/python-exactness takes
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
import gymnasium
from gymnasium.utils.env_match import check_environments_match

parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
parser.add_argument("--steps", type=int, default=100, help="steps per run (default 100)")
parser.add_argument("--seeds", type=int, default=3, help="seeds per game (default 3)")
parser.add_argument(
    "--parts", type=int, default=52, help="number of parts of the runs; one part is played (default 52)"
)
parser.add_argument(
    "--part", type=int, default=datetime.date.today().toordinal(), help="which one (default: by the day)"
)
options = parser.parse_args([])

ale_py.ALEInterface.setLoggerMode(ale_py.LoggerMode.Error)


def check(name, obs_type, seed):
    envs = [
        gymnasium.make(f"{namespace}/{name}-v5", obs_type=obs_type, disable_env_checker=True)
        for namespace in ("racebeam", "ALE")
    ]
    assert all(env.unwrapped.ale.getFloat("repeat_action_probability") == 0.25 for env in envs)
    check_environments_match(*envs, options.steps, seed=seed, info_comparison="equivalence")
    for env in envs:
        env.close()


def differences():
    """Plays the runs of a part. Returns a line for each that differs, and the number of runs."""
    runs = list(itertools.product(names(), ("rgb", "grayscale", "ram"), range(options.seeds)))[
        options.part % options.parts :: options.parts
    ]
    found = []
    for run in runs:
        try:
            check(*run)
        except AssertionError as difference:
            found.append(f"{run}: {str(difference)[:200]}")
    return found, len(runs)


def names(namespace="ALE"):
    return sorted(spec.name for spec in gymnasium.registry.values() if spec.namespace == namespace)


def test_racebeam_has_each_id_of_ale():
    assert set(names()) - set(names("racebeam")) == set()


@pytest.mark.slow
@pytest.mark.needs_roms
def test_no_run_of_today_differs():
    differing_runs.check(*differences())


if __name__ == "__main__":
    options = parser.parse_args()
    sys.exit(differing_runs.report(*differences()))
