"""Measures the cost of the line protocol over standard streams, a Unix socket and TCP.

A step is one act, answered with reward, ends, lives, RAM and the screen as runs. Steps of one client are compared with
an echo server on plain sockets that sends the same bytes, and with the same session in process. Then follow the bytes a
frame by encoding, and 64 machines in one session compared with one.

Rates are of elapsed time: medians of nine rounds. Ratios are medians of the ratios within a round. Microseconds are
processor time of the serving process for a step, which other processes disturb less. Client and server either have a
processor each ("apart"), so that every wait ends with waking a thread. Or the system places them ("free"), often on
one processor.
"""

import argparse
import itertools
import json
import os
import statistics
import subprocess
import sys

from cartridges import ROOT, image_or_own, name_of

BUILD = ROOT / "build/release"
RACEBEAM, WIRE_BENCH = BUILD / "racebeam", BUILD / "tests/server/wire_bench"
GAMES = [
    "asterix",
    "beam_rider",
    "breakout",
    "freeway",
    "montezuma_revenge",
    "ms_pacman",
    "pong",
    "qbert",
    "seaquest",
    "space_invaders",
]
ENCODINGS = [
    "screen:hex",
    "screen:rle",
    "screen:delta",
    "screen:base64",
    "screen:zlib",
    "grey84x84x1:base64",
    "grey84x84x1:zlib",
    "ram",
]
TRANSPORTS = ("stdio", "unix", "tcp")


def parse_arguments():
    parser = argparse.ArgumentParser(
        prog="scripts/bench wire", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--games", nargs="+", default=GAMES, metavar="GAME", help="games for the bytes (default: ten)")
    parser.add_argument(
        "--speed-games", nargs="+", default=["pong", "seaquest"], metavar="GAME", help="games for the steps"
    )
    parser.add_argument("--steps", type=int, default=4000, help="steps of one round (default 4000)")
    parser.add_argument(
        "--placement",
        nargs="+",
        default=["apart", "free"],
        choices=["apart", "free"],
        help="placement of client and server on the processors (default: both)",
    )
    parser.add_argument(
        "--ahead",
        type=int,
        nargs="+",
        default=[1, 16],
        help="requests in flight; 1 waits for each reply (default 1 16)",
    )
    return parser.parse_args()


class Session:
    """A session on standard streams."""

    def __init__(self, rom, *options):
        self.process = subprocess.Popen(
            [RACEBEAM, "serve", "--stdio", "--rom", rom, "--log-level", "warning", *options],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
        )
        self.ask(f"load {name_of(rom)} seed=1 sticky=0 max_episode_frames=0")

    def ask(self, request):
        self.process.stdin.write(request.encode() + b"\n")
        self.process.stdin.flush()
        reply = self.process.stdout.readline()
        if not reply.startswith(b"ok"):
            sys.exit(f"bench: {request}: {reply.decode()}")
        return reply

    def close(self):
        self.process.stdin.close()
        self.process.stdout.close()
        self.process.wait()


def ratio(own, *others):
    """The median over rounds of the ratio to the slowest of the others in the same round."""
    return statistics.median(
        rates[0] / min(rates[1:]) for rates in zip(own["rates"], *(other["rates"] for other in others))
    )


def print_speed(game, steps, ahead, placement, one_write=False):
    rom = image_or_own(game)
    apart = ["--apart"] if placement == "apart" else []
    options = apart + (["--one-write"] if one_write else [])
    done = subprocess.run(
        [WIRE_BENCH, *options, RACEBEAM, rom, str(steps), str(ahead)], capture_output=True, check=True
    )
    found = json.loads(done.stdout)
    in_process = found["in_process"]
    how = f"{placement}, {ahead} under way" + (", sent in one write" if one_write else "")
    print(
        f"\n{name_of(rom)}, {how}, {found['bytes']:.0f} bytes a reply; in process "
        f"{in_process['rate']:.0f} steps/s, {in_process['microseconds']:.1f} us"
    )
    print(f"{'':8}{'steps/s':>10}{'echo':>10}{'of less':>9}{'us':>8}{'echo us':>9}{'extra us':>10}")
    for transport in TRANSPORTS:
        own, echo = found[transport], found["echo_" + transport]
        extra = own["microseconds"] - in_process["microseconds"] - echo["microseconds"]
        print(
            f"{transport:8}{own['rate']:10.0f}{echo['rate']:10.0f}{ratio(own, in_process, echo):9.2f}"
            f"{own['microseconds']:8.1f}{echo['microseconds']:9.1f}{extra:10.1f}",
            flush=True,
        )


def print_bytes(games, frames=1000):
    print(f"\nbytes a frame, mean of {frames} frames of random play\n{'':20}" + "".join(f"{e:>15}" for e in ENCODINGS))
    for game in games:
        session = Session(image_or_own(game))
        means = []
        for encoding in ENCODINGS:
            session.ask("reset")
            session.ask("observe " + encoding)
            total = sum(len(session.ask(f"act {frame // 4 * 7 % 6}").partition(b"=")[2]) - 1 for frame in range(frames))
            means.append(total / frames)
        print(f"{name_of(image_or_own(game)):20}" + "".join(f"{mean:15.0f}" for mean in means), flush=True)
        session.close()


def print_batch(game, machines=64):
    """Compares many machines in one session with one in process, with the same fields and settings. With two requests
    in flight, a client sends the actions of a step before it reads the reply to the previous step."""
    rom = image_or_own(game)
    print(
        f"\n{name_of(rom)}, {machines} machines in one session on {os.cpu_count()} processors, steps/s and "
        f"times one in process"
    )
    for ahead, words in itertools.product(
        (1, 2),
        (
            "reward terminated truncated",
            "reward terminated truncated lives ram screen:rle",
            "reward terminated truncated frame_skip=4",
            "reward terminated truncated lives ram screen:rle frame_skip=4",
        ),
    ):
        done = subprocess.run(
            [WIRE_BENCH, "--machines", str(machines), RACEBEAM, rom, "5000", str(ahead), *words.split()],
            capture_output=True,
            check=True,
        )
        found = json.loads(done.stdout)
        in_process = found["in_process"]
        print(
            f"{ahead} under way, {words:60}{in_process['rate']:9.0f}"
            + "".join(
                f"{transport:>8}{found[transport]['rate']:8.0f}{ratio(found[transport], in_process):6.2f}"
                for transport in TRANSPORTS
            )
        )


def main():
    arguments = parse_arguments()
    subprocess.run([ROOT / "scripts/build", "racebeam", "wire_bench"], check=True, stdout=sys.stderr)
    for game in arguments.speed_games:
        for ahead, placement in itertools.product(arguments.ahead, arguments.placement):
            print_speed(game, arguments.steps, ahead, placement)
            if ahead > 1:
                print_speed(game, arguments.steps, ahead, placement, one_write=True)
    for game in arguments.speed_games:
        print_batch(game)
    print_bytes(arguments.games)


if __name__ == "__main__":
    main()
