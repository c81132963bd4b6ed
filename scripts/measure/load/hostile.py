"""scripts/load --hostile: sessions that request as much as they can, and their effect on others.

A server with two threads and 512 MiB is attacked twice, each time a new one. The first attack is of 64 sessions. Each
repeats one of the ATTACKS of attacks.py: it connects, attacks and disconnects. The second one is of its HOARDERS,
on the memory. A bystander with its own game acts every few milliseconds, and requests /healthz. During the second
attack, newcomers connect, load a game and act; the time counts until they have managed. At the end, the server is told
to stop during the attack. If one of the goals is missed, the exit status is 1.
"""

import itertools
import math
import multiprocessing
import os
import socket
import sys
import threading
import time

import crowd
import processor
from attacks import ATTACKS, HOARDERS, STRANGERS, TOKEN, Session

SESSIONS, THREADS, GRACE, MEMORY = 64, 2, 2, 512
# In milliseconds, except memory, which is in MiB, and SIGTERM, which is in seconds.
GOALS = {"bystander p99": 20, "/healthz p99": 50, "newcomer max": 1000, "memory": MEMORY, "SIGTERM": GRACE + 1}
REQUESTS = [function for number, function in zip(range(SESSIONS), itertools.cycle(ATTACKS.values()))]


def keep_attacking(function, port, folder):
    while True:
        try:
            session = Session(port, folder)
        except OSError:
            Session.replies["(no connection)"] += 1
            time.sleep(0.1)
            continue
        try:
            if function not in STRANGERS:
                session.admit()
            function(session)
        except OSError:
            Session.replies["(connection lost)"] += 1
        session.socket.close()


def attack_all(functions, port, folder, orders, answers):
    """A process of attackers. It reports their replies from time to time."""
    os.nice(5)
    for function in functions:
        threading.Thread(target=keep_attacking, args=(function, port, folder), daemon=True).start()
    orders.recv()
    answers.send(dict(Session.replies))
    orders.recv()


def raise_priority():
    try:
        os.setpriority(os.PRIO_PROCESS, 0, -15)
    except PermissionError:
        print("load: cannot raise the priority: the bystander's figures include delays of the system", file=sys.stderr)


def watch(ask_once, pause, stop, answers):
    """A process that times `ask_once()` until it is stopped, and sends milliseconds."""
    raise_priority()
    waits = []
    while not stop.poll():
        start = time.perf_counter()
        ask_once()
        waits.append((time.perf_counter() - start) * 1000)
        time.sleep(pause)
    answers.send(waits)


class Refused(Exception):
    pass


class Player:
    def __init__(self, port):
        connection = socket.create_connection(("127.0.0.1", port))
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.lines = connection.makefile("rwb", buffering=0)
        connection.close()  # once the lines are
        for line in (b"hello token=" + TOKEN, b"load beamfall max_episode_frames=0"):
            self.ask(line)

    def ask(self, line):
        self.lines.write(line + b"\n")
        reply = self.lines.readline()
        if not reply.startswith(b"ok"):
            raise Refused(reply)


class Bystander:
    """Its session has begun before the attack. It is never refused."""

    def __init__(self, port):
        self.player = Player(port)

    def __call__(self):
        try:
            self.player.ask(b"act NOOP")
        except (Refused, OSError) as error:
            sys.exit(f"load: the bystander got {error!r}")


class Newcomers:
    """One after the other. Who is refused tries again, for half a minute."""

    def __init__(self, port):
        self.port = port

    def __call__(self):
        end = time.monotonic() + 30
        while time.monotonic() < end:
            try:
                player = Player(self.port)
                player.ask(b"act NOOP")
                player.lines.close()
                return
            except (Refused, OSError):
                time.sleep(0.02)


class Health:
    def __init__(self, port):
        self.address = ("127.0.0.1", port)

    def __call__(self):
        with socket.create_connection(self.address) as connection:
            connection.sendall(b"GET /healthz HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n")
            reply = connection.makefile("rb").read()
        if not reply.startswith(b"HTTP/1.1 200"):
            sys.exit(f"load: /healthz said {reply[:80]!r}")


class Helper:
    """Starts a process next to the server."""

    def __init__(self, function, *arguments):
        self.requests, there = multiprocessing.Pipe()
        self.answers, back = multiprocessing.Pipe()
        self.process = multiprocessing.Process(target=function, args=(*arguments, there, back), daemon=True)
        self.process.start()
        there.close()  # so that ask() fails once the process has ended
        back.close()

    def ask(self):
        self.requests.send(None)
        return self.answers.recv()


class Target(crowd.Server):
    """The server that is attacked. records: the folder of its recordings."""

    def __init__(self, build):
        super().__init__(build, grace=GRACE, log_level="error")
        tokens, self.records = self.place / "tokens", self.place / "records"
        tokens.write_bytes(TOKEN + b"\n")
        tokens.chmod(0o600)
        self.records.mkdir()
        self.command += ["--http", "127.0.0.1:0", "--threads", str(THREADS), "--max-memory", f"{MEMORY}M"]
        self.command += ["--token-file", tokens, "--record-dir", self.records, "--record-limit", "20000000"]

    def peak_memory(self):
        """The highest resident memory, in MiB."""
        with open(f"/proc/{self.process.pid}/status") as status:
            return next(int(line.split()[1]) for line in status if line.startswith("VmHWM")) / 1024


def percentile(waits, share):
    """The nearest rank: the least wait that at least `share` of all waits do not exceed. Share 0: the least wait."""
    rank = math.ceil(round(share * len(waits), 6))  # 0.07 * 100 is more than 7
    return sorted(waits)[max(rank, 1) - 1]


def show_waits(name, waits):
    print(
        f"{name:14}{len(waits):8}" + "".join(f"{percentile(waits, share):10.2f}" for share in (0.5, 0.99, 1)),
        flush=True,
    )


def measure(attack, server, seconds):
    watchers = {
        "bystander": Helper(watch, Bystander(server.port), 0.003),
        "/healthz": Helper(watch, Health(server.http), 0.05),
    }
    attackers = Helper(attack_all, attack, server.port, server.records)
    if attack is HOARDERS:
        watchers["newcomer"] = Helper(watch, Newcomers(server.port), 0.2)
    time.sleep(seconds)
    print(f"{'':14}{'asked':>8}" + "".join(f"{key:>10}" for key in ("p50 ms", "p99 ms", "max ms")))
    found = {}
    for name, watcher in watchers.items():
        waits = watcher.ask()
        show_waits(name, waits)
        found |= {name + " p99": percentile(waits, 0.99), name + " max": max(waits)}
    replies = attackers.ask()
    print("attackers got: " + ", ".join(f"{count} {kind}" for kind, count in sorted(replies.items())))
    found["memory"] = server.peak_memory()
    found["SIGTERM"] = server.stop()
    attackers.process.terminate()
    return found


def judge(found):
    """Prints whether each goal has been reached. Returns whether all have."""
    units = {"memory": "MiB", "SIGTERM": "s"}
    goals_met = {name: found[name] < goal for name, goal in GOALS.items() if name in found}
    for name, good in goals_met.items():
        print(
            f"{name:14}{found[name]:10.2f} {units.get(name, 'ms'):4} below {GOALS[name]:4}: "
            f"{'ok' if good else 'MISSED'}"
        )
    return all(goals_met.values())


def attack_one(name, attack, build, seconds):
    """Returns whether the server has withstood it."""
    print(f"\n{name}: {len(attack)} attackers")
    with Target(build) as server:
        found = measure(attack, server, seconds)
    is_sound = judge(found)
    print(f"the server ended with status {server.status}")
    return is_sound and server.status == 0


def run(build, seconds):
    """Returns the exit status."""
    print(
        f"{THREADS} threads, {os.cpu_count()} processors ({processor.name()}), load {os.getloadavg()[0]:.1f}, "
        f"{seconds:g} seconds each"
    )
    withstood = [attack_one(*attack, build, seconds) for attack in (("requests", REQUESTS), ("memory", HOARDERS))]
    return int(not all(withstood))
