"""What the tests share that compare racebeam.ale_py with ale_py."""

import os
import subprocess
import sys

import ale_py
import package
import racebeam
import racebeam.ale_py as drop_in
import racebeam.ale_py._ale_py

ale_py.ALEInterface.setLoggerMode(ale_py.LoggerMode.Error)

# What is below ALEVectorInterface (difference 15).
INTERNAL = {"AutoresetMode", "VectorXLAReset", "VectorXLAResetGPU", "VectorXLAStep", "VectorXLAStepGPU"}

PONG = None if "pong" not in package.roms() else racebeam.find_image("pong")


def pong():
    """The interface of either package, with a game that was loaded with a seed."""
    both = []
    for module in (drop_in, ale_py):
        ale = module.ALEInterface()
        ale.setInt("random_seed", 7)
        ale.setBool("sound_obs", True)
        ale.loadROM(PONG)
        both.append(ale)
    return both


def in_process(script, **environment):
    return subprocess.run(
        [sys.executable, "-c", script], env={**os.environ, **environment}, capture_output=True, text=True
    )


def interfaces(count, **settings):
    """The vector interface of either package."""
    return [module.ALEVectorInterface(PONG, count, **settings) for module in (drop_in, ale_py)]
