"""Attacks on the Python package by the arrays of its caller, which change while machines play."""

import pathlib
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from attack import PATIENCE, Lacking, attack, fault_of_end

PYTHON = pathlib.Path(__file__).resolve().parents[2] / "build/python/venv/bin/python"

# Two threads: one steps, the other changes what it was given and what it got. Prints the number of steps.
PROGRAM = """
import random, sys, threading
import numpy as np
import racebeam

chance, steps = random.Random(int(sys.argv[1])), int(sys.argv[2])
kinds = [dict(), dict(obs_type="rgb", img_width=0, img_height=0), dict(obs_type="ram"), dict(sound_obs=True)]
kind = chance.choice(kinds)
envs = racebeam.AtariVectorEnv("beamfall", 4, seed=1, num_threads=2, **kind)
twin = racebeam.AtariVectorEnv("beamfall", 4, seed=1, num_threads=2, **kind)
observations, _ = envs.reset()
twin.reset()
shape = observations.shape if isinstance(observations, np.ndarray) else None
out = None if shape is None else np.empty(shape, observations.dtype)
actions = np.zeros(4, np.int64)
seen, ended = [observations], threading.Event()
own = isinstance(observations, np.ndarray)

def change():
    while not ended.is_set():
        array = chance.choice([actions, out, *(seen if own else [])])
        if array is None:
            continue
        try:
            chance.choice([
                lambda: array.resize(chance.randrange(1, 1 << 20)),
                lambda: setattr(array, "shape", (-1,)),
                lambda: setattr(array, "dtype", np.int8),
                lambda: setattr(array, "strides", (0,) * array.ndim),
                lambda: array.setflags(write=chance.random() < 0.5),
                lambda: array.fill(chance.randrange(100)),
            ])()
        except (ValueError, AttributeError, TypeError, IndexError):
            pass

thread = threading.Thread(target=change)
thread.start()
done = 0
for _ in range(steps):
    if chance.random() < 0.1 or actions.shape != (4,) or actions.dtype != np.int64:
        actions = np.zeros(4, np.int64)
    if own and (chance.random() < 0.1 or out.shape != shape):
        out = np.empty(shape, seen[0].dtype)
    try:
        result = envs.step(actions, out=out) if own and chance.random() < 0.5 else envs.step(actions)
        seen[:] = [result[0]]
        done += 1
    except (ValueError, TypeError, IndexError, racebeam.InvalidInput):
        pass
ended.set()
thread.join()
reset, _ = envs.reset(seed=7)
other, _ = twin.reset(seed=7)
for _ in range(10):
    a, b = envs.step(np.ones(4, np.int64)), twin.step(np.ones(4, np.int64))
    for left, right in zip(a[:2], b[:2]):
        for name in left if isinstance(left, dict) else [...]:
            assert (left[name] == right[name]).all(), "the environments were disturbed"
print(done)
"""


@attack(times=20)
def arrays_that_change(chance, times):
    """Arrays of actions, of `out=` and of observations are resized, reshaped and filled while `step` runs. A step is
    refused by an exception, or is made; afterwards the environments play as new ones."""
    if not PYTHON.exists():
        raise Lacking("scripts/wheel --venv has not made the environment of the Python package")
    for _ in range(times):
        command = [PYTHON, "-B", "-c", PROGRAM, str(chance.randrange(10**6)), "2000"]
        done = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE)
        yield fault_of_end(done.returncode, "" if done.returncode == 0 else done.stderr, (0,))
        yield "" if done.returncode or int(done.stdout) > 0 else "no step was made"
