"""scripts/load --soak HOURS: a server under a mixed load for hours. Its memory, files and latencies must stay flat.

One server with two threads and 512 MiB serves these together: sessions that play, search, save, record, open machines
and leave in different ways; one attacker for each of the ATTACKS of attacks.py; and a page's WebSockets that watch a
game. After each interval, their processes are killed. The server then rests for some seconds, and they begin anew. A
bystander acts every few milliseconds, and requests /healthz.

The figures of each interval go to soak.csv, and at the end to soak.svg. What a server under load holds depends on what
its clients happen to do, so that memory and files are judged at rest. The first tenth is not judged, since caches fill
then. The last third of the rest is compared with its first third, by medians. The exit status is 1 if a figure exceeds
its limit, or if the server does not end with status 0 when it is told to.
"""

import collections
import contextlib
import csv
import pathlib
import random
import re
import statistics
import sys
import threading
import time
import urllib.request

import bench_picture
import hostile
from attacks import ATTACKS, LONG, Session

ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path[:0] = [str(ROOT / "tests/server"), str(ROOT / "tests/server/web")]
from web_socket import WebSocket  # noqa: E402

PLAYERS, WATCHERS, REST = 6, 4, 6  # sessions; seconds
GAMES = (b"beamfall", b"updraft")
FIGURES = {  # by column: its heading, and how much the last third may have of the first one, times and plus
    "rest_resident": ("Resident memory at rest, MiB", 1.1, 8),
    "rest_files": ("Open files at rest", 1, 4),
    "threads": ("Threads", 1, 0),
    "p99": ("99th percentile of a bystander's act, ms", 1.5, 2),
    "health_p99": ("99th percentile of /healthz, ms", 1.5, 5),
}
SHOWN = {"resident": "Resident memory under load, MiB", "files": "Open files under load"}  # and not judged


def plays(session):
    session.ask(b"observe reward terminated ram screen:delta")
    for _ in range(20):
        session.ask(b"act " + b" ".join(random.choice((b"LEFT*4", b"RIGHT*4", b"FIRE")) for _ in range(20)))


def searches(session):
    session.ask(
        b"save root",
        b"export root",
        b"act FIRE*30",
        b"branch root LEFT*40 RIGHT*40 FIRE*40",
        b"restore root",
        b"drop root",
    )


def steps(session):
    session.ask(b"observe reward grey84x84x4:zlib", b"open 8 autoreset=next-step", *[b"step FIRE"] * 20, b"close")


def records(session):
    name = f"soak-{threading.get_ident()}"
    session.ask(f"record y4m {name}".encode(), b"act RIGHT*60", b"record stop")
    for path in pathlib.Path(session.folder).glob(name + "*"):
        path.unlink(missing_ok=True)


def leaves(session):
    session.send(b"act NOOP*20000")


def play_on(port, folder):
    """One session after another, each with a game and one of the ways to use it."""
    while True:
        try:
            session = Session(port, folder)
            session.admit()
            session.ask(b"load " + random.choice(GAMES) + b" sticky=0.25")
            random.choice((plays, searches, steps, records, leaves))(session)
            session.socket.close()
        except OSError:
            time.sleep(0.1)
        time.sleep(0.05)


def share(port, folder):
    """A session that plays for those who watch."""
    session = Session(port, folder)
    session.admit()
    session.ask(LONG, b"share soak")
    while True:
        session.ask(b"act LEFT FIRE RIGHT")
        time.sleep(0.05)


def watch(port):
    session = WebSocket(port)
    session.ask(b"hello token=" + hostile.TOKEN)
    while True:
        session.ask(b"watch soak screen:delta")
        time.sleep(1 / 30)


def run_threads(tasks, orders, answers):
    """A process with a thread for each task, a function and its arguments. It runs until it is killed."""
    for function, *arguments in tasks:
        threading.Thread(target=function, args=arguments, daemon=True).start()
    orders.recv()


def time_requests(ask_once, pause, orders, answers):
    """A process that times `ask_once()`. At each order, it sends the milliseconds since the last one."""
    hostile.raise_priority()
    waits = []
    while True:
        while not orders.poll():
            start = time.perf_counter()
            ask_once()
            waits.append((time.perf_counter() - start) * 1000)
            time.sleep(pause)
        orders.recv()
        answers.send(waits)
        waits = []


class Watchers:
    """The bystander and the reader of /healthz, which stay."""

    def __init__(self, server):
        self.bystander = hostile.Helper(time_requests, hostile.Bystander(server.port), 0.005)
        self.health = hostile.Helper(time_requests, hostile.Health(server.http), 0.1)

    def end(self):
        for helper in (self.bystander, self.health):
            helper.process.kill()


@contextlib.contextmanager
def load(server):
    """Loads the server with players, attackers and watchers, which are killed at the end of the block."""
    place = (server.port, server.records)
    helpers = [
        hostile.Helper(run_threads, [(play_on, *place)] * PLAYERS),
        hostile.Helper(run_threads, [(share, *place)]),
        hostile.Helper(hostile.attack_all, list(ATTACKS.values()), *place),
        hostile.Helper(run_threads, [(watch, server.http)] * WATCHERS),
    ]
    try:
        yield
    finally:
        for helper in helpers:
            helper.process.kill()
            helper.process.join()


def resources(server):
    """Returns MiB of resident memory, open files and threads."""
    place = pathlib.Path(f"/proc/{server.process.pid}")
    status = dict(re.findall(r"^(\w+):\s*(\d+)", (place / "status").read_text(), re.MULTILINE))
    return int(status["VmRSS"]) / 1024, len(list((place / "fd").iterdir())), int(status["Threads"])


def latencies(watchers, interval):
    """The latencies since the last call. Without an act, its latency is the whole interval."""
    acts, pages = watchers.bystander.ask(), watchers.health.ask()
    return {
        "acts": len(acts),
        "p50": hostile.percentile(acts or [1000 * interval], 0.5),
        "p99": hostile.percentile(acts or [1000 * interval], 0.99),
        "health_p99": hostile.percentile(pages or [1000 * interval], 0.99),
    }


def show_totals(http):
    """Prints what the server has done, from its metrics."""
    with urllib.request.urlopen(f"http://127.0.0.1:{http}/metrics") as page:
        lines = re.findall(r"^racebeam_(\w+)(\{.*\})? (\d+)$", page.read().decode(), re.MULTILINE)
    sessions = sum(int(count) for name, _, count in lines if name == "sessions_total")
    requests, errors = collections.Counter(), 0
    for name, labels, count in lines:
        if name == "requests_total":
            requests[re.search(r'command="(\w+)"', labels)[1]] += int(count)
            errors += int(count) * ('outcome="error"' in labels)
    print(f"{sessions:,} sessions made {requests.total():,} requests, of which {errors:,} had an error:")
    print("  " + ", ".join(f"{count:,} {name}" for name, count in requests.most_common() if count))


def compare(rows):
    """Returns, by figure: medians of the first and of the last third after the first tenth, the limit, and the growth
    an hour."""
    kept = rows[len(rows) // 10 :]
    third = max(len(kept) // 3, 1)
    hours = [row["seconds"] / 3600 for row in kept]
    found = {}
    for name, (_, times, plus) in FIGURES.items():
        values = [row[name] for row in kept]
        first, last = statistics.median(values[:third]), statistics.median(values[-third:])
        growth = statistics.linear_regression(hours, values).slope if len(set(hours)) > 1 else 0.0
        found[name] = (first, last, first * times + plus, growth)
    return found


def judge(rows):
    """Prints the comparison. Returns whether all figures have stayed within their limits."""
    print(f"{'':42}{'first third':>12}{'last third':>12}{'limit':>10}{'growth an hour':>16}")
    sound = True
    for name, (first, last, limit, growth) in compare(rows).items():
        verdict = "ok" if last <= limit else "EXCEEDED"
        print(f"{FIGURES[name][0]:42}{first:12.2f}{last:12.2f}{limit:10.2f}{growth:16.3f}  {verdict}")
        sound &= last <= limit
    return sound


def write_interval(path, row):
    is_new = not path.exists()
    with path.open("a", newline="") as file:
        table = csv.DictWriter(file, row, lineterminator="\n")
        if is_new:
            table.writeheader()
        table.writerow({name: round(value, 3) for name, value in row.items()})


def measure_interval(server, watchers, interval):
    """An interval of load, and a rest. Returns its figures by the name of their column."""
    with load(server):
        time.sleep(interval)
        resident, files, threads = resources(server)
        row = latencies(watchers, interval)
    time.sleep(REST)
    rest_resident, rest_files, _ = resources(server)
    latencies(watchers, REST)  # forgets those at rest
    return {
        "resident": resident,
        "files": files,
        "threads": threads,
        "rest_resident": rest_resident,
        "rest_files": rest_files,
        **row,
    }


def follow(server, watchers, hours, interval, table):
    """Returns the rows of all intervals, until the time is over or the server has ended."""
    rows, begin = [], time.monotonic()
    while time.monotonic() - begin < hours * 3600:
        try:
            row = measure_interval(server, watchers, interval)
        except (EOFError, OSError):  # the server has ended, and so has the bystander
            break
        rows.append({"seconds": time.monotonic() - begin, **row})
        write_interval(table, rows[-1])
    return rows


def measure(build, hours, interval, table):
    """Returns the rows of all intervals, and whether the server has lasted and ended with status 0."""
    with hostile.Target(build) as server:
        watchers = Watchers(server)
        try:
            rows = follow(server, watchers, hours, interval, table)
            has_lasted = server.process.poll() is None
            if has_lasted:
                show_totals(server.http)
        finally:
            watchers.end()
        took = server.stop()
    when = f"{took:.1f} s after SIGTERM" if has_lasted else "before its time"
    print(f"the server ended with status {server.status}, {when}")
    return rows, has_lasted and server.status == 0


def run(build, hours, interval, into):
    """Returns the exit status."""
    into.mkdir(parents=True, exist_ok=True)
    (into / "soak.csv").unlink(missing_ok=True)
    rows, is_sound = measure(build, hours, interval, into / "soak.csv")
    if not rows:
        sys.exit("load: the server ended in the first interval")
    headings = {name: heading for name, (heading, *_) in FIGURES.items()} | SHOWN
    picture = bench_picture.draw_course([row["seconds"] / 3600 for row in rows], rows, headings)
    (into / "soak.svg").write_text(picture)
    is_flat = judge(rows)
    print(
        f"{len(rows)} intervals, {sum(row['acts'] for row in rows):,} acts of the bystander: {into}/soak.csv, soak.svg"
    )
    return int(not is_flat or not is_sound)
