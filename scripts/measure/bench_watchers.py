"""Measures what watchers cost the agent that they watch: its acts a second, alone and with watchers.

The agent plays Beamfall over TCP, four frames an act, and sends 16 acts at once. Each watcher is a WebSocket that asks
for the newest picture 60 times a second; the watchers have their own process. The settings take turns, so that
other work on the machine meets all of them. Figures are medians of the rounds. Exit status 1: the goal is missed.
"""

import argparse
import multiprocessing
import os
import pathlib
import statistics
import sys
import threading
import time

from crowd import processor_seconds

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "tests/server"), str(ROOT / "tests/server/web")]
GOAL = 0.95  # of the acts a second without watchers
AHEAD = 16
ACTS = b"act FIRE\nact RIGHT\nact LEFT\nact UP\n" * (AHEAD // 4)


def watch(port, stop, seen):
    from web_socket import WebSocket

    session, frame = WebSocket(port), b"-1"
    while not stop.is_set():
        since = time.monotonic()
        reply = session.ask(b"watch room since=" + frame + b" screen:delta")
        frame = reply.split(b" frame=")[1].split()[0]
        seen.append(b" screen=" in reply)
        time.sleep(max(0, 1 / 60 - (time.monotonic() - since)))
    session.close()


def watch_all(port, count, ready, ended):
    """A process with all watchers. It tells how many pictures each has seen."""
    stop, arrivals = threading.Event(), []
    watchers = [threading.Thread(target=watch, args=(port, stop, arrivals)) for _ in range(count)]
    for watcher in watchers:
        watcher.start()
    ready.send(True)
    ended.recv()
    stop.set()
    for watcher in watchers:
        watcher.join()
    ready.send(sum(arrivals))


def play(agent, seconds):
    """Plays for so long. Returns acts a second."""
    begin, acts = time.monotonic(), 0
    while time.monotonic() - begin < seconds:
        agent.send(ACTS)
        replies = 0
        while replies < AHEAD:
            replies += agent.read(1 << 20).count(b"\n")
        acts += AHEAD
    return acts / (time.monotonic() - begin)


def measure(watchers, seconds):
    """Acts a second, microseconds of the server's processor time for each, and pictures a second of all watchers."""
    from harness import Server, ask, connect_tcp

    with Server(
        "serve", "--listen", "tcp://127.0.0.1:0", "--listen", "ws://127.0.0.1:0", "--threads", "2", "--grace", "0"
    ) as server:
        port = int(server.wait_for(r"listening on ws://127\.0\.0\.1:(\d+)$")[1])
        agent = connect_tcp(server.port())
        ask(agent, b"load beamfall seed=1 sticky=0 frame_skip=4 autoreset=1 max_episode_frames=0")
        ask(agent, b"observe reward grey84x84x4:delta")
        ask(agent, b"share room")
        (orders, ready), (ended, stop) = multiprocessing.Pipe(False), multiprocessing.Pipe(False)
        process = multiprocessing.Process(target=watch_all, args=(port, watchers, ready, ended))
        process.start()
        orders.recv()
        play(agent, seconds / 4)
        begin, processor_time = time.monotonic(), processor_seconds(server.process.pid)
        rate = play(agent, seconds)
        processor_time = processor_seconds(server.process.pid) - processor_time
        duration = time.monotonic() - begin
        stop.send(True)
        pictures = orders.recv()
        process.join()
        agent.close()
        return rate, 1e6 * processor_time / (rate * duration), pictures / (1.25 * duration)


def main():
    parser = argparse.ArgumentParser(
        prog="scripts/bench watchers", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "--watchers", type=int, nargs="+", default=[0, 1, 16], metavar="N", help="how many; the first is the base"
    )
    parser.add_argument("--seconds", type=float, default=5, help="seconds per measurement (default: %(default)s)")
    parser.add_argument("--rounds", type=int, default=5, help="rounds over all settings (default: %(default)s)")
    options = parser.parse_args()
    os.environ.setdefault("RACEBEAM_BINARY", str(ROOT / "build/release/racebeam"))
    rounds = [[measure(count, options.seconds) for count in options.watchers] for _ in range(options.rounds)]
    base, is_slow = None, False
    print("| watchers | acts/s | of those without | server, us/act | pictures/s |\n|---:|---:|---:|---:|---:|")
    for place, count in enumerate(options.watchers):
        rate, cost, pictures = (statistics.median(each[place][figure] for each in rounds) for figure in range(3))
        base = base or rate
        is_slow |= rate < GOAL * base
        print(f"| {count} | {rate:,.0f} | {100 * rate / base:.1f} % | {cost:.1f} | {pictures:.0f} |")
    print(f"goal: at least {100 * GOAL:.0f} %; {'missed' if is_slow else 'met'}")
    return int(is_slow)


if __name__ == "__main__":
    sys.exit(main())
