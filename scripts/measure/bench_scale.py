"""Measures what one server carries: the figures of docs/scale.md.

steps: 64 sessions act as fast as they can, for each of several observations. Microseconds are the server's processor
time of a step; their inverse is the steps a second of a core. The client runs on the same machine and takes its share
of it, so that steps/s are fewer than the processors could do. MB/s are of replies, for a core that does nothing else.
cores: the same by processors of the server, with reward, ends and RAM; clients use all of the machine.
sessions: the same for several numbers of acting sessions, with reward, ends and RAM. idle: memory and processor time of
sessions that wait, in the server and in the kernel, after they have loaded a game. crowd: 50,000 sessions on several
servers, of which 500 act ten times a second; latencies of the acts.

Other programs distort steps/s and latencies; the load average is printed for that. Processor time suffers less.
"""

import argparse
import os
import pathlib
import subprocess
import time
from contextlib import ExitStack

from bench_report import machine
from cartridges import ROOT, image_or_own, name_of
from crowd import Crowd, Server

SHOWN = (
    "reward terminated truncated",
    "reward terminated truncated ram",
    "screen:delta",
    "grey84x84x1:zlib",
    "screen:zlib",
    "screen:rle",
    "grey84x84x1:base64",
    "screen:base64",
)
PARTS = ("steps", "cores", "sessions", "idle", "crowd")
ACTORS = 64  # of steps
ACTING = 500  # of crowd
PAUSE = 4  # seconds; sessions release their caches after two


def parse_arguments():
    parser = argparse.ArgumentParser(
        prog="scripts/bench scale", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("parts", nargs="*", default=PARTS, metavar="PART", help=f"{', '.join(PARTS)} (default: all)")
    parser.add_argument("--game", default="seaquest", help="for steps and sessions (default: seaquest)")
    parser.add_argument("--frame-skip", type=int, default=4)
    parser.add_argument("--seconds", type=float, default=5, help="seconds per measurement (default 5)")
    parser.add_argument(
        "--acting", type=int, nargs="+", default=[1, 16, 64, 256, 1024], help="numbers of acting sessions"
    )
    parser.add_argument("--idle", type=int, nargs="+", default=[1000, 8000], help="numbers of idle sessions")
    parser.add_argument("--crowd", type=int, default=50000, help="sessions of crowd (default 50000)")
    parser.add_argument(
        "--servers",
        type=int,
        default=3,
        help="servers of the measurement crowd, since a process may open only some files (default 3)",
    )
    parser.add_argument(
        "--build", type=pathlib.Path, help="folder of a build (default: build/release, which is built first)"
    )
    found = parser.parse_args()
    if unknown := set(found.parts) - set(PARTS):
        parser.error(f"unknown part {', '.join(unknown)}; accepted: {', '.join(PARTS)}")
    return found


def acting(arguments, sessions, observe, processors=None):
    """The client's result, with the server's processor time and memory."""
    rom = image_or_own(arguments.game)
    options = [] if rom.startswith("builtin:") else ["--rom", rom]
    load = f"load {name_of(rom)} seed=1 sticky=0 max_episode_frames=0 frame_skip={arguments.frame_skip}"
    with Server(arguments.build, *options, processors=processors) as server:
        empty = server.resident()
        with Crowd(
            arguments.build, server, sessions, sessions, arguments.seconds, 0, load=load, observe=observe
        ) as crowd:
            crowd.wait()
            before = server.processor_seconds()
            crowd.begin()
            found = crowd.end()
            spent = server.processor_seconds() - before
            memory = server.resident() - empty
    acts = found["acts"]
    return {
        "rate": acts / found["seconds"],
        "us": 1e6 * spent / acts,
        "bytes": found["bytes"] / acts,
        "kib": memory / sessions,
        "busy": spent / found["seconds"],
        "p99": found["p99"],
    }


def steps(arguments):
    print(
        f"\n{name_of(image_or_own(arguments.game))}, frame_skip={arguments.frame_skip}, {ACTORS} sessions\n\n"
        "| observation | bytes a reply | steps/s | us of a core | steps/s a core | MB/s a core |\n|---|---:|---:|"
        "---:|---:|---:|"
    )
    for field in SHOWN:
        found = acting(arguments, ACTORS, f"observe {field}")
        of_core = 1e6 / found["us"]
        print(
            f"| `{field}` | {found['bytes']:,.0f} | {found['rate']:,.0f} | {found['us']:.1f} | {of_core:,.0f} | "
            f"{of_core * found['bytes'] / 1e6:,.1f} |",
            flush=True,
        )


def cores(arguments):
    print("\n| cores of the server | steps/s | us of a core | cores that it used |\n|---:|---:|---:|---:|")
    usable = sorted(os.sched_getaffinity(0))
    for count in range(1, len(usable) + 1):
        found = acting(arguments, ACTORS, "observe reward terminated truncated ram", usable[:count])
        print(f"| {count} | {found['rate']:,.0f} | {found['us']:.1f} | {found['busy']:.2f} |", flush=True)


def sessions(arguments):
    print("\n| acting sessions | steps/s | us of a core | p99, ms | KiB a session |\n|---:|---:|---:|---:|---:|")
    for count in arguments.acting:
        found = acting(arguments, count, "observe reward terminated truncated ram")
        print(
            (
                f"| {count:,} | {found['rate']:,.0f} | {found['us']:.1f} | {found['p99'] / 1000:,.2f} | "
                f"{found['kib']:,.0f} |"
            ),
            flush=True,
        )


def kernel_memory():
    """Returns the memory of all objects of the kernel, sockets among them, in KiB."""
    slab = next(line for line in pathlib.Path("/proc/meminfo").read_text().splitlines() if line.startswith("Slab:"))
    return int(slab.split()[1])


def idle(arguments):
    print(
        "\n| idle sessions | connected in, s | KiB a session | in the kernel, KiB | of a core |\n"
        "|---:|---:|---:|---:|---:|"
    )
    for count in arguments.idle:
        with Server(arguments.build, "--max-sessions", "20000") as server:
            empty, kernel, began = server.resident(), kernel_memory(), time.monotonic()
            with Crowd(arguments.build, server, count, 0, 0, 0) as crowd:
                crowd.wait()
                seconds = time.monotonic() - began
                time.sleep(PAUSE)
                before, begins = server.processor_seconds(), time.monotonic()
                time.sleep(arguments.seconds)
                share = (server.processor_seconds() - before) / (time.monotonic() - begins)
                print(
                    f"| {count:,} | {seconds:.1f} | {(server.resident() - empty) / count:.1f} | "
                    f"{(kernel_memory() - kernel) / count:.1f} | {share:.1%} |",
                    flush=True,
                )


def shares(total, parts):
    return [total // parts + (part < total % parts) for part in range(parts)]


def crowd(arguments):
    with ExitStack() as stack:
        servers = [
            stack.enter_context(Server(arguments.build, "--max-sessions", "20000")) for _ in range(arguments.servers)
        ]

        def all_of(what):
            return sum(getattr(server, what)() for server in servers)

        empty, kernel, began = all_of("resident"), kernel_memory(), time.monotonic()
        crowds = [
            stack.enter_context(Crowd(arguments.build, server, idle + acting, acting, 2 * arguments.seconds, 100))
            for server, idle, acting in zip(
                servers, shares(arguments.crowd, arguments.servers), shares(ACTING, arguments.servers)
            )
        ]
        for one in crowds:
            one.wait()
        connected = time.monotonic() - began
        time.sleep(PAUSE)
        before = all_of("processor_seconds")
        for one in crowds:
            one.begin()
        found = [one.end() for one in crowds]
        seconds = max(one["seconds"] for one in found)
        spent, memory = all_of("processor_seconds") - before, all_of("resident") - empty
        kernel = kernel_memory() - kernel
    count = arguments.crowd + ACTING
    print(
        f"\n{arguments.crowd:,} idle and {ACTING} acting sessions on {arguments.servers} servers, connected in "
        f"{connected:.1f} s\n"
        f"memory: {memory / 2**20:.2f} GiB, {memory / count:.1f} KiB a session; in the kernel "
        f"{kernel / count:.1f} KiB a session\n"
        f"{sum(one['acts'] for one in found) / seconds:,.0f} acts/s take {spent / seconds:.0%} of a core; the "
        f"worst server's latency: "
        f"p50 {max(one['p50'] for one in found) / 1000:.2f} ms, p99 {max(one['p99'] for one in found) / 1000:.2f} ms",
        flush=True,
    )


def main():
    arguments = parse_arguments()
    if arguments.build is None:
        subprocess.run([ROOT / "scripts/build", "racebeam", "load_client"], check=True, stdout=subprocess.DEVNULL)
        arguments.build = ROOT / "build/release"
    about = machine()
    print(f"{about['processor']}, {about['processors']} processors; load average {os.getloadavg()[0]:.1f}")
    for part in arguments.parts:
        {"steps": steps, "cores": cores, "sessions": sessions, "idle": idle, "crowd": crowd}[part](arguments)


if __name__ == "__main__":
    main()
