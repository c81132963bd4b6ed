"""racebeam's AtariVectorEnv beside ale_py's, and EnvPool's where it is installed: steps a second of all environments
together, 84x84x4, with the threads that each takes by itself.

All play chunks of random actions in turns; racebeam and ale_py have to show the same. Wall-clock time counts. "async"
receives a third of the environments at a time. A ratio is the median of the chunks' ratios: racebeam to the better of
ale_py and both of EnvPool's. Then racebeam in this process, and on a server over a Unix socket and over TCP; ratios are
to in process. Then all beside a learner, a process that multiplies matrices on one processor all the time. At the end:
what only Python takes of a step, with 64 environments that do nothing. Needs `scripts/wheel --venv`;
`build/python/venv/bin/pip install envpool` adds EnvPool.
"""

import argparse
import contextlib
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time
import zlib

import_error = None
try:
    import numpy as np
    from ale_py import ALEInterface, LoggerMode
    from ale_py.vector_env import AtariVectorEnv as Reference
    from racebeam import AtariVectorEnv, images, program

    random = np.random.default_rng(1)
except ImportError as error:
    import_error = error
try:
    import envpool
except ImportError:
    envpool = None

GAMES = "pong,breakout,seaquest,qbert,ms_pacman,freeway,asterix,beam_rider,space_invaders,up_n_down"


def parse_arguments():
    parser = argparse.ArgumentParser(
        prog="scripts/bench vector", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--games", default=GAMES, help=f"A,B (default {GAMES})")
    parser.add_argument("--envs", default="16,64", help="numbers of environments (default 16,64)")
    parser.add_argument(
        "--steps", type=int, default=1600, help="steps per chunk, of all environments together (default 1600)"
    )
    parser.add_argument("--chunks", type=int, default=7, help="chunks per game (default 7)")
    parser.add_argument("--only", choices=COMPARISONS, help="one of the comparisons (default: all of them)")
    return parser.parse_args()


def play_together(envs, count, steps):
    """The seconds of the steps, and a checksum of what they showed."""
    digest, spent = 0, 0.0
    for actions in random.integers(envs.single_action_space.n, size=(steps, count), dtype=np.int32):
        begin = time.perf_counter()
        observations, rewards, *_ = envs.step(actions)
        spent += time.perf_counter() - begin
        digest = zlib.crc32(rewards.astype(np.int32), zlib.crc32(np.ascontiguousarray(observations[:, -1]), digest))
    return spent, digest


def play_apart(envs, batch, steps):
    """The seconds of as many steps, where the environments that are ready go on."""
    begin = time.perf_counter()
    for _ in range(steps):
        *_, info = envs.recv()
        envs.send(random.integers(envs.single_action_space.n, size=batch, dtype=np.int32), *own_ids(envs, info))
    return time.perf_counter() - begin, 0


def own_ids(envs, info):
    return () if isinstance(envs, (AtariVectorEnv, Reference)) else (info["env_id"],)


def pool(game, count, batch):
    task = "".join(word.title() for word in game.split("_"))
    return envpool.make(f"{task}-v5", env_type="gymnasium", num_envs=count, batch_size=batch, reward_clip=True)


def players(game, count):
    """The name of each, how it plays a chunk, and its size."""
    third = max(count // 3, 1)
    together = {"ale_py": Reference(game, count), "racebeam": AtariVectorEnv(game, count)}
    apart = {"racebeam async": AtariVectorEnv(game, count, batch_size=third)}
    if envpool is not None:
        together["EnvPool"], apart["EnvPool async"] = pool(game, count, count), pool(game, count, third)
    for envs in together.values():
        envs.reset(seed=1) if isinstance(envs, (AtariVectorEnv, Reference)) else envs.reset()
    apart["racebeam async"].reset(seed=1)
    apart["racebeam async"].send(np.zeros(third, np.int32))
    if envpool is not None:
        apart["EnvPool async"].async_reset()
    return {
        **{name: (play_together, envs, count) for name, envs in together.items()},
        **{name: (play_apart, envs, third) for name, envs in apart.items()},
    }


def measure(game, count, options):
    """The steps a second of each, and the ratio."""
    everyone, times = players(game, count), {}
    state = random.bit_generator.state
    for chunk in range(options.chunks + 1):
        digests = {}
        for name, (play, envs, batch) in everyone.items():
            random.bit_generator.state = state  # all play the same actions
            steps = options.steps // batch
            spent, digests[name] = play(envs, batch, steps)
            if chunk > 0:  # the first makes tables and code
                times.setdefault(name, []).append(spent / (steps * batch))
        if digests["racebeam"] != digests["ale_py"]:
            raise SystemExit(f"bench: {game}: racebeam and ale_py do not show the same")
        random.integers(2, size=chunk + 1)
        state = random.bit_generator.state
    for _, envs, _ in everyone.values():
        envs.close()
    ours = zip(times["racebeam"], times["racebeam async"])
    theirs = zip(*(times[name] for name in times if not name.startswith("racebeam")))
    ratio = statistics.median(min(other) / min(racebeam_time) for racebeam_time, other in zip(ours, theirs))
    return {name: 1 / statistics.median(each) for name, each in times.items()}, ratio


@contextlib.contextmanager
def server(image):
    """Addresses of a server that has the image."""
    with tempfile.TemporaryDirectory() as folder:
        ready = pathlib.Path(folder, "ready")
        process = subprocess.Popen(
            [
                program.path(),
                "serve",
                "--listen",
                f"unix:{folder}/socket",
                "--listen",
                "tcp://127.0.0.1:0",
                "--rom",
                image,
                "--ready-file",
                ready,
                "--log-level",
                "warning",
            ]
        )
        try:
            while not ready.exists():
                if process.poll() is not None:
                    raise SystemExit(f"bench: the server ended with status {process.returncode}")
                time.sleep(0.01)
            yield [line for line in ready.read_text().splitlines() if not line.startswith("#")]
        finally:
            process.terminate()
            process.wait()


def measure_servers(game, count, options):
    """Steps a second in this process, over a Unix socket and over TCP."""
    with server(images.find(game)) as addresses, contextlib.ExitStack() as stack:
        everyone = [
            stack.enter_context(contextlib.closing(AtariVectorEnv(game, count, **where)))
            for where in ({}, *({"server": address} for address in addresses))
        ]
        for envs in everyone:
            envs.reset(seed=1)
        times = [[] for _ in everyone]
        for chunk in range(options.chunks + 1):
            state, digests = random.bit_generator.state, set()
            for envs, seconds in zip(everyone, times):
                random.bit_generator.state = state
                spent, digest = play_together(envs, count, options.steps // count)
                digests.add(digest)
                if chunk > 0:
                    seconds.append(spent)
            if len(digests) > 1:
                raise SystemExit(f"bench: {game}: racebeam shows something else on a server")
    return [options.steps // count * count / statistics.median(seconds) for seconds in times]


LEARNER = """
import numpy
weights = numpy.ones((256, 256), numpy.float32)
while True:
    weights = numpy.tanh(weights @ weights)
"""


@contextlib.contextmanager
def learner():
    """A process that keeps one processor busy."""
    variables = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    process = subprocess.Popen([sys.executable, "-c", LEARNER], env={**os.environ, **variables})
    try:
        yield
    finally:
        process.kill()
        process.wait()


def step_times(envs, count, steps):
    """The seconds of each step."""
    times = []
    for actions in random.integers(envs.single_action_space.n, size=(steps, count), dtype=np.int32):
        begin = time.perf_counter()
        envs.step(actions)
        times.append(time.perf_counter() - begin)
    return times


def measure_beside_learner(game, count, options):
    """Microseconds of a step, as a median and a 99th percentile, alone and beside a learner."""
    everyone = {
        "ale_py": Reference(game, count),
        "racebeam": AtariVectorEnv(game, count),
        "one thread": AtariVectorEnv(game, count, num_threads=1),
        "bound": AtariVectorEnv(game, count, thread_affinity_offset=0),
    }
    if envpool is not None:
        everyone["EnvPool"] = pool(game, count, count)
    rows = {}
    for name, envs in everyone.items():
        envs.reset() if name == "EnvPool" else envs.reset(seed=1)
    for company in (contextlib.nullcontext, learner):
        times = {name: [] for name in everyone}
        with company():
            for _ in range(options.chunks):
                for name, envs in everyone.items():
                    times[name] += step_times(envs, count, options.steps // count)
        for name, each in times.items():
            rows.setdefault(name, []).extend(np.percentile(each, (50, 99)) * 1e6)
    for envs in everyone.values():
        envs.close()
    return rows


def compare_alone(count, options):
    ratios = []
    for game in options.games.split(","):
        speeds, ratio = measure(game, count, options)
        if not ratios:
            print(f"{f'{count} environments':<18}" + "".join(f"{name:>16}" for name in speeds) + f"{'ratio':>8}")
        ratios.append(ratio)
        print(f"{game:<18}" + "".join(f"{speed:16.0f}" for speed in speeds.values()) + f"{ratio:8.2f}", flush=True)
    mean = statistics.geometric_mean(ratios)
    print(f"{'geometric mean':<18}{mean:{16 * len(speeds) + 8}.2f}   least {min(ratios):.2f}")


def compare_servers(count, options):
    print(f"{f'{count} environments':<18}{'in process':>16}{'Unix':>16}{'TCP':>16}{'Unix':>8}{'TCP':>8}")
    ratios = []
    for game in options.games.split(","):
        speeds = measure_servers(game, count, options)
        ratios.append([speed / speeds[0] for speed in speeds[1:]])
        print(
            f"{game:<18}"
            + "".join(f"{speed:16.0f}" for speed in speeds)
            + "".join(f"{ratio:8.2f}" for ratio in ratios[-1]),
            flush=True,
        )
    print(f"{'geometric mean':<66}" + "".join(f"{statistics.geometric_mean(column):8.2f}" for column in zip(*ratios)))


def compare_beside_learner(count, options):
    print(f"{f'{count} environments':<30}{'us of a step':>14}{'p99':>8}{'beside a learner':>18}{'p99':>8}")
    for game in options.games.split(","):
        for name, (alone, late, beside, late_beside) in measure_beside_learner(game, count, options).items():
            print(f"{game:<18}{name:<12}{alone:14.0f}{late:8.0f}{beside:18.0f}{late_beside:8.0f}", flush=True)


class IdleMachines:
    """Machines whose steps do nothing."""

    def __init__(self, machines):
        self._machines = machines

    def __getattr__(self, name):
        return getattr(self._machines, name)

    def step(self, actions, results):
        results.flags[:] = False


def python_alone():
    """Microseconds of a step."""
    envs = AtariVectorEnv("beamfall", 64, seed=1)
    actions = np.zeros(64, np.int64)
    envs.step(actions)
    envs._machines = IdleMachines(envs._machines)
    times = []
    for _ in range(3000):
        begin = time.perf_counter()
        envs.step(actions)
        times.append(time.perf_counter() - begin)
    return statistics.median(times) * 1e6


COMPARISONS = {"alone": compare_alone, "servers": compare_servers, "learner": compare_beside_learner}


def main():
    options = parse_arguments()
    if import_error:
        raise SystemExit(f"bench: {import_error}; scripts/wheel --venv installs it")
    ALEInterface.setLoggerMode(LoggerMode.Error)
    for compare in [COMPARISONS[options.only]] if options.only else COMPARISONS.values():
        for count in map(int, options.envs.split(",")):
            compare(count, options)
    print(f"only Python takes {python_alone():.1f} us of a step")


if __name__ == "__main__":
    main()
