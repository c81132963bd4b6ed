"""Calls everything that the package has with random arguments, on objects that are new, closed, in use by other
threads, or on a server.

    fuzz.py [--seconds N] [--seed N] [--calls N]

Each round of calls is a process with its own seed. A crash, a report of a sanitizer, a round that takes longer
than PATIENCE seconds, and an exception that is not documented are findings. Exit status: 1 if there are any.
scripts/check/python-fuzz runs it under AddressSanitizer.
"""

import argparse
import faulthandler
import pickle
import random
import re
import subprocess
import sys
import threading
import time
import traceback

import fuzz_servers
import numpy as np
import racebeam
import racebeam.ale_py
import racebeam.envpool
import racebeam.presets
from gymnasium.error import ClosedEnvironmentError, Error
from racebeam import _core

PATIENCE = 120  # seconds
LONGEST = 200  # frames of an act
DOCUMENTED = (TypeError, IndexError, racebeam.InvalidInput, Error, ClosedEnvironmentError, *fuzz_servers.DOCUMENTED)
DELIBERATE = re.compile(
    "can't be provided for|each must be -1, 0 or 1|not been reset yet|must reset every|seeds? (for|is)|seeds have the "
    "shape|must have shape|"
    "duplicate env_id|needs batch_size|is given for one array|receive (it|them) first|send some first|must be a "
    "float32 array|"
    "must be an array of|actions have the shape|" + fuzz_servers.DELIBERATE  # of other types
)
KEYS = (
    "random_seed",
    "reward_min",
    "sound_obs",
    "rules",
    "max_num_frames_per_episode",
    "repeat_action_probability",
    "color_averaging",
)

LEFT_OUT = (
    "saveScreenPNG",
    "xla",
    "get_wrapper_attr",
    "set_wrapper_attr",
)  # writes files; needs JAX (test_xla.py); Gymnasium's

chance = random.Random()


def array(*shape, kind=np.uint8):
    return np.full(shape, chance.choice([0, 1, 3]), kind)


def value():
    """Something: mostly what some function takes, though perhaps not this one."""
    return chance.choice(
        [
            lambda: chance.choice(
                [0, 1, -1, 2, 3, 17, 18, 99, 2**31 - 1, 2**31, 2**63, -(2**70), 0.5, float("nan"), float("inf")]
            ),
            lambda: chance.choice(
                [None, True, "", "FIRE", "beamfall", "Pong-v5", "rgb", b"", b"xx", (), {}, [1], [[1], [2, 3]], *KEYS]
            ),
            lambda: chance.choice(
                [*racebeam.Action, *_core.View, *_core.Autoreset, np.int64(3), np.float32(0.5), racebeam.ALEState()]
            ),
            lambda: array(
                chance.choice([0, 1, 2, 3, 128, 512]),
                kind=chance.choice([np.uint8, np.int32, np.int64, np.float32, np.bool_]),
            ),
            lambda: array(
                chance.choice([2, 210, 420]),
                chance.choice([3, 4, 160]),
                kind=chance.choice([np.uint8, np.int32, np.float32]),
            ),
            lambda: chance.choice([array(210, 160, 3), array(420, 160)[::2], array(2, 4, 84, 84), array(2, 3)[:, ::2]]),
            lambda: {
                chance.choice(["reset_mask", "env_id", "action", ""]): array(
                    2, kind=chance.choice([np.bool_, np.int32])
                )
            },
        ]
    )()


def results(count, size=4 * 84 * 84):
    """Arrays for VectorMachines to fill; one in ten is something else."""
    parts = [
        array(count * size),
        None,
        array(6, count, kind=np.int32),
        array(4, count, kind=np.bool_),
        array(count * size),
        array(3, count, kind=np.int32),
        chance.choice([None, array(3, count, kind=np.int32)]),
    ]
    if chance.random() < 0.1:
        parts[chance.randrange(len(parts))] = value()
    return tuple(parts)


def vector_settings():
    settings = _core.VectorSettings()
    settings.stack, settings.width, settings.height = 4, 84, 84
    for _ in range(chance.randrange(3)):
        name = chance.choice([name for name in dir(settings) if not name.startswith("_")])
        setattr(settings, name, value())
    settings.threads = min(settings.threads, 8)  # vector_settings.py has a limit; the core takes what the system has
    return settings


def machines(count=2):
    return _core.VectorMachines([("builtin:beamfall", "beamfall")], np.zeros(count, np.int32), vector_settings())


VECTOR = {
    "num_envs": (1, 2, 3),
    "batch_size": (0, 1, 2),
    "num_threads": (1, 2),
    "autoreset_mode": ("NextStep", "SameStep", "Disabled"),
    "obs_type": (None, "ram", "rgb"),
    "continuous": (True, False),
    "render_mode": (None, "rgb_array"),
    "frameskip": (1, 4),
    "lives": ("ignored", "end", "restart"),
    "max_num_frames_per_episode": (9, 1000),
}
ENV = {
    "obs_type": ("rgb", "grayscale", "ram"),
    "frameskip": (1, (2, 5)),
    "continuous": (True, False),
    "render_mode": (None, "rgb_array"),
    "sound_obs": (True, False),
    "two_player": (True, False),
    "preset": tuple(racebeam.presets.PRESETS),
}
POOL = {
    "num_envs": (1, 2, 3),
    "batch_size": (0, 1, 2),
    "gray_scale": (True, False),
    "episodic_life": (True, False),
    "env_type": ("gym", "gymnasium", "dm"),
    "max_episode_steps": (3, 100),
    "env_seed": ([], [1, 2]),
    "seed": (1, [1, 2]),
    "use_fire_reset": (True, False),
    "zero_discount_on_life_loss": (True, False),
    "max_num_players": (1,),
    "gym_reset_return_info": (None, True),
    "mode": (-1, 0),
    "difficulty": (-1, 0),
    "repeat_action_probability": (0.0, 0.25),
    "img_height": (84, 21),
    "noop_max": (0, 30),
    "stack_num": (1, 4),
    "thread_affinity_offset": (-1, 0),
    "num_threads": (0, 1),
}


def arguments_of(table):
    """Some of the table, one in five of them senseless."""
    settings = {name: chance.choice(values) for name, values in table.items() if chance.random() < 0.4}
    if chance.random() < 0.2:
        settings[chance.choice(list(table))] = value()
    return settings


def game():
    return chance.choice(["beamfall", "updraft"])


MAKERS = {
    "ALEInterface": lambda: racebeam.ALEInterface(),
    "ALEState": lambda: racebeam.ALEState(*chance.choice([(), (value(),)])),
    "AtariEnv": lambda: racebeam.AtariEnv(game(), **arguments_of(ENV)),
    "AtariVectorEnv": lambda: racebeam.AtariVectorEnv(game(), **arguments_of(VECTOR)),
    "ALEVectorInterface": lambda: racebeam.ale_py.ALEVectorInterface(f"builtin:{game()}", 2),
    "ale_py.AtariVectorEnv": lambda: racebeam.ale_py.AtariVectorEnv(game(), **arguments_of(VECTOR)),
    "envpool": lambda: racebeam.envpool.make(
        "Beamfall-v5", **{"env_type": chance.choice(["gymnasium", "gym", "dm"]), **arguments_of(POOL)}
    ),
    "VectorMachines": machines,
}
SERVERS = fuzz_servers.Servers(chance, game, lambda: arguments_of(ENV), lambda: arguments_of(VECTOR))
MAKERS.update(SERVERS.makers())
FUNCTIONS = [_core.games, _core.md5s, _core.identify, _core.image_files, _core.xla_handle]


def sensible(thing, method):
    """Arguments that the method takes, if they are known."""
    if method in ("step", "act") and isinstance(thing, racebeam.ALEInterface):
        return [chance.randrange(18), 1.0, chance.choice([1, 4, LONGEST]), chance.choice(list(_core.View))][
            : 4 if method == "step" else 1
        ]
    if method == "loadROM":
        return [f"builtin:{game()}"]
    if method in ("step", "send") and isinstance(thing, racebeam.envpool.EnvPool):
        some = chance.sample(range(len(thing)), chance.randint(0, min(len(thing), 5)))
        return chance.choice([[np.zeros(len(thing), int)], [np.ones(len(some), int), np.array(some, int)]])
    if method in ("step", "send") and hasattr(thing, "action_space"):
        return [thing.action_space.sample()]
    if isinstance(thing, _core.VectorMachines):
        one = {
            "step": [array(2, kind=np.int64), results(2)],
            "send": [array(2, kind=np.int64), np.arange(2, dtype=np.int32)],
            "receive": [results(chance.randrange(3))],
            "end_episodes": [np.array(chance.sample(range(2), chance.randrange(3)), np.int32), None],
            "reset": [None, None, results(2)],
            "show": [results(2)],
            "send_resets": [None],
            "save": [0, True],
        }
        return one.get(method, [])
    return []


def is_too_long(method, arguments):
    """Returns whether only an interrupt ends such a step, which test_threads.py tests."""
    return (
        method == "step"
        and len(arguments) > 2
        and isinstance(arguments[2], (int, np.integer))
        and arguments[2] > LONGEST
    )


def call(thing, kept):
    """One call of a random method."""
    if isinstance(thing, racebeam.Session):
        SERVERS.ask(thing)
        return
    method = chance.choice([name for name in dir(thing) if not name.startswith("_") and name not in LEFT_OUT])
    arguments = (
        sensible(thing, method) if chance.random() < 0.6 else [value() for _ in range(chance.choice([0, 1, 1, 2, 3]))]
    )
    if method in ("restore", "restoreState", "restore_state") and kept and chance.random() < 0.7:
        arguments = [0, chance.choice(kept)][-1 if method != "restore" else 0 :]
    member = getattr(thing, method)
    if not callable(member) or is_too_long(method, arguments):
        return
    result = member(*arguments)
    if isinstance(result, (racebeam.ALEState, _core.SavedMachine)):
        kept[:] = [*kept[-8:], result]


def documented(act, *arguments):
    """What `act` returns, or None if it is refused."""
    try:
        return act(*arguments)
    except DOCUMENTED:
        return None
    except Exception as error:
        if DELIBERATE.search(str(error)):
            return None
        raise


def round_of_calls(calls, failures):
    states = []
    thing = None
    for _ in range(calls):
        try:
            if thing is None or chance.random() < 0.02:
                thing = documented(chance.choice(list(MAKERS.values()))) or thing
            if chance.random() < 0.01:
                documented(chance.choice(FUNCTIONS), *[value() for _ in range(chance.randrange(4))])
            if chance.random() < 0.005:
                chance.choice(SERVERS.checks())()
            if thing is not None and not isinstance(thing, racebeam.Session) and chance.random() < 0.01:
                thing = documented(lambda: pickle.loads(pickle.dumps(thing))) or thing
            if states and chance.random() < 0.01:
                states.append(pickle.loads(pickle.dumps(chance.choice(states))))
            if thing is None:
                continue
            if chance.random() < 0.05 and not isinstance(thing, racebeam.Session):
                together(thing, states, failures)
            documented(call, thing, states)
        except Exception:
            failures.append(traceback.format_exc())
            return


def together(thing, kept, failures):
    """Three threads use one object."""

    def use():
        try:
            for _ in range(5):
                documented(call, thing, kept)
        except Exception:
            failures.append(traceback.format_exc())

    threads = [threading.Thread(target=use) for _ in range(3)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()


def one_round(seed, calls):
    faulthandler.enable()
    chance.seed(seed)
    failures = []
    round_of_calls(calls, failures)
    print(*failures, sep="\n")
    sys.exit(bool(failures))


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--seconds", type=float, default=60)
    parser.add_argument(
        "--seed",
        type=int,
        default=random.SystemRandom().randrange(10**9),
        help="seed of the first round; the next has one more",
    )
    parser.add_argument("--calls", type=int, default=600, help="calls per round")
    parser.add_argument("--round", action="store_true", help="play one round in this process")
    options = parser.parse_args()
    if options.round:
        one_round(options.seed, options.calls)
    end, rounds, found = time.monotonic() + options.seconds, 0, 0
    while time.monotonic() < end:
        words = ["--round", "--calls", str(options.calls), "--seed", str(options.seed + rounds)]
        rounds += 1
        try:
            done = subprocess.run(
                [sys.executable, "-B", __file__, *words], capture_output=True, text=True, timeout=PATIENCE
            )
        except subprocess.TimeoutExpired as late:
            found += 1
            print(f"{' '.join(words)}: takes longer than {late.timeout} seconds")
            continue
        if done.returncode != 0:
            found += 1
            print(f"{' '.join(words)}: status {done.returncode}\n{done.stdout[-3000:]}{done.stderr[-6000:]}")
    print(f"{rounds} rounds of {options.calls} calls, {found} findings")
    sys.exit(found > 0)


if __name__ == "__main__":
    main()
