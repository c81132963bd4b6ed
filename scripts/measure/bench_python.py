"""racebeam's AtariEnv beside ale_py's, in one process: steps a second, four frames a step, for each kind of
observation.

Both play chunks of the same random actions in turns, and have to show the same. Only the processor time of the steps
counts; resets are left out. The ratio is the median of the chunks' ratios. Needs `scripts/wheel --venv`.
"""

import argparse
import statistics
import time
import zlib

import_error = None
try:
    import ale_py
    import racebeam
except ImportError as error:
    import_error = error

GAMES = "pong,breakout,seaquest,qbert,ms_pacman,freeway,asterix,beam_rider,space_invaders,up_n_down"
KINDS = ("rgb", "grayscale", "ram")


def parse_arguments():
    parser = argparse.ArgumentParser(
        prog="scripts/bench python", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--games", default=GAMES, help=f"A,B (default {GAMES})")
    parser.add_argument("--steps", type=int, default=100, help="steps per chunk (default 100)")
    parser.add_argument("--chunks", type=int, default=9, help="chunks per game (default 9)")
    return parser.parse_args()


def play(env, actions):
    """The processor time of the steps, and a checksum of what they showed."""
    spent, digest = 0.0, 0
    for action in actions:
        begin = time.process_time()
        observation, reward, terminated, truncated, _ = env.step(action)
        spent += time.process_time() - begin
        digest = zlib.crc32(f"{reward} {terminated}".encode(), zlib.crc32(observation, digest))
        if terminated or truncated:
            env.reset()
    return spent, digest


def measure(game, kind, steps, chunks):
    """Steps a second of ALE and of racebeam, and the ratio; medians of the chunks."""
    both = [module.AtariEnv(game, obs_type=kind) for module in (ale_py, racebeam)]
    for env in both:
        env.reset(seed=1)
    space = both[0].action_space
    space.seed(1)
    times = []
    for chunk in range(chunks + 1):
        actions = [int(space.sample()) for _ in range(steps)]
        (theirs, seen), (ours, shown) = (play(env, actions) for env in both)
        if seen != shown:
            raise SystemExit(f"bench: {game}, {kind}: the two do not show the same")
        if chunk > 0:  # the first makes tables and code
            times.append((theirs, ours))
    return (
        steps / statistics.median(theirs for theirs, _ in times),
        steps / statistics.median(ours for _, ours in times),
        statistics.median(theirs / ours for theirs, ours in times),
    )


def main():
    options = parse_arguments()
    if import_error:
        raise SystemExit(f"bench: {import_error}; scripts/wheel --venv installs it")
    ale_py.ALEInterface.setLoggerMode(ale_py.LoggerMode.Error)
    print(f"{'game':<16}" + "".join(f"{kind:>28}" for kind in KINDS))
    print(f"{'':<16}" + f"{'ALE':>10}{'racebeam':>10}{'ratio':>8}" * len(KINDS))
    ratios = {kind: [] for kind in KINDS}
    for game in options.games.split(","):
        row = ""
        for kind in KINDS:
            theirs, ours, ratio = measure(game, kind, options.steps, options.chunks)
            ratios[kind].append(ratio)
            row += f"{theirs:10.0f}{ours:10.0f}{ratio:8.2f}"
        print(f"{game:<16}{row}", flush=True)
    print(f"{'geometric mean':<16}" + "".join(f"{statistics.geometric_mean(ratios[kind]):28.2f}" for kind in KINDS))


if __name__ == "__main__":
    main()
