#!/usr/bin/env python3
"""Simulates how a cluster works through a plan, with nodes that fail and nodes that are slow.

    python3 cluster/simulate.py paper --cores 64 --nodes 10 20 40
    python3 cluster/simulate.py paper --cores 64 --within 24 --pilot results

A core runs one task after the other. A task is a shard of the plan, by default a unit. When a node fails, its tasks
lose what they did since their last checkpoint, and wait for --requeue before another core continues them. Prints hours
and core-hours, the median and the 95th percentile over --runs simulations. --within HOURS searches for the fewest nodes
for which 95 % of the simulations end in time.

The lengths of units are those of `racebeam experiment PLAN --dry-run --unmeasured`, which takes all episodes to be as
long as they may be. With --pilot, a folder of results, they come from its times.csv: seconds of a frame, and frames of
an episode, by agent. A unit gets those of a game of the pilot, drawn at random.
"""

from __future__ import annotations

import argparse
import csv
import heapq
import itertools
import math
import pathlib
import random
import re
import statistics
import subprocess
import sys
from collections import deque
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, fields, replace


@dataclass(frozen=True)
class Cluster:
    """Times are in seconds. A node fails `failures` times a year on average; 0: never."""

    nodes: int
    cores: int = 1  # of a node
    failures: float = 0
    repair: float = 3600  # until a node that failed is back
    requeue: float = 120  # until its tasks may begin again
    checkpoint: float = 60  # between two checkpoints of a task
    slow: float = 0  # the share of nodes that are slow
    slowness: float = 2  # how many times as long a task takes there


@dataclass(frozen=True)
class Run:
    """What a simulation found, in seconds. busy: of all cores together; lost: work that was done twice."""

    elapsed: float
    busy: float
    lost: float
    failures: int


YEAR = 365 * 86400.0


class Simulation:
    def __init__(self, tasks: Iterable[float], cluster: Cluster, chance: random.Random) -> None:
        self.cluster, self.chance = cluster, chance
        self.waiting = deque(tasks)  # seconds of work that are left
        self.unfinished = len(self.waiting)
        self.slowness = [cluster.slowness if chance.random() < cluster.slow else 1.0 for _ in range(cluster.nodes)]
        # The node of each idle core. The last one works next, so that the first node is filled first.
        self.idle = [node for node in reversed(range(cluster.nodes)) for _ in range(cluster.cores)]
        # Of each node, by number: work, and its begin.
        self.running: list[dict[int, tuple[float, float]]] = [{} for _ in range(cluster.nodes)]
        self.events: list[tuple[float, int, Callable[..., None], tuple[object, ...]]] = []
        self.numbers = itertools.count()
        self.now = self.busy = self.lost = 0.0
        self.failures = 0

    def run(self) -> Run:
        for node in range(self.cluster.nodes):
            self.expect_failure(node)
        self.assign()
        while self.unfinished > 0:
            self.now, _, event, arguments = heapq.heappop(self.events)
            event(*arguments)
            self.assign()
        return Run(self.now, self.busy, self.lost, self.failures)

    def after(self, seconds: float, event: Callable[..., None], *arguments: object) -> None:
        heapq.heappush(self.events, (self.now + seconds, next(self.numbers), event, arguments))

    def assign(self) -> None:
        while self.waiting and self.idle:
            node, work, number = self.idle.pop(), self.waiting.popleft(), next(self.numbers)
            self.running[node][number] = work, self.now
            self.after(work * self.slowness[node], self.finish, node, number)

    def finish(self, node: int, number: int) -> None:
        if number not in self.running[node]:
            return  # the node failed before
        _, began = self.running[node].pop(number)
        self.busy += self.now - began
        self.unfinished -= 1
        self.idle.append(node)

    def expect_failure(self, node: int) -> None:
        if self.cluster.failures > 0:
            self.after(self.chance.expovariate(self.cluster.failures / YEAR), self.fail, node)

    def fail(self, node: int) -> None:
        self.failures += 1
        for work, began in self.running[node].values():
            spent = self.now - began
            saved = math.floor(spent / self.cluster.checkpoint) * self.cluster.checkpoint
            self.busy += spent
            self.lost += spent - saved
            self.after(self.cluster.requeue, self.waiting.appendleft, work - saved / self.slowness[node])
        self.running[node].clear()
        self.idle = [idle for idle in self.idle if idle != node]
        self.after(self.cluster.repair, self.return_from_repair, node)

    def return_from_repair(self, node: int) -> None:
        self.idle += [node] * self.cluster.cores
        self.expect_failure(node)


def shards_of(units: Sequence[float], count: int) -> list[float]:
    """The lengths of shards, which take units as `racebeam experiment --shard K/N` does."""
    return [sum(units[shard::count]) for shard in range(min(count, len(units)))]


def simulate(units: Sequence[float], cluster: Cluster, shards: int = 0, seed: int = 0) -> Run:
    """units: their seconds on a core that is not slow. shards: 0 for a task a unit."""
    return Simulation(shards_of(units, shards or len(units)), cluster, random.Random(seed)).run()


# The lengths of units

ROW = re.compile(r"(\w+) +(\d+) units +(\d+) decisions +([\d.]+) core-hours")


@dataclass(frozen=True)
class Agent:
    """An agent of a plan: how many units, their decisions at most, and seconds of one."""

    name: str
    units: int
    decisions: float
    seconds: float


def agents_of(dry_run: str) -> list[Agent]:
    """What `racebeam experiment PLAN --dry-run --unmeasured` printed. Raises ValueError for another text."""
    rows = [row for row in ROW.findall(dry_run) if row[0] != "all"]
    if not rows:
        raise ValueError("the text has no line such as 'basic 55 units 1000 decisions 0.1 core-hours'")
    return [
        Agent(name, int(units), int(decisions) / int(units), float(hours) * 3600 / int(units))
        for name, units, decisions, hours in rows
    ]


def lengths_of(
    agents: Sequence[Agent], measured: dict[str, list[tuple[float, float]]], chance: random.Random
) -> list[float]:
    """Seconds of all units in the order of the plan: by game, then by agent. measured: as pilot_of() returns it."""
    games = math.gcd(*(agent.units for agent in agents))
    lengths = []
    for _ in range(games):
        for agent in agents:
            length = agent.seconds
            if agent.name in measured:
                part, seconds = chance.choice(measured[agent.name])
                length = agent.decisions * part * seconds
            lengths += [length] * (agent.units // games)
    return lengths


def rows_of(table: pathlib.Path) -> list[dict[str, str]]:
    with table.open(newline="") as lines:
        return list(csv.DictReader(lines))


def pilot_of(results: pathlib.Path) -> dict[str, list[tuple[float, float]]]:
    """Returns two numbers for each unit in a folder of results, by agent.

    They are the mean length of an episode, as a part of the longest, and the seconds of a decision. Raises OSError if
    a file is missing, and ValueError if the plan does not say how long an episode may be.
    """
    plan = results / "plan.toml"
    found_longest = re.search(r"max_episode_frames=(\d+)", plan.read_text())
    if not found_longest:
        raise ValueError(f"{plan} does not say max_episode_frames=N")
    longest = float(found_longest[1])
    episodes: dict[str, list[dict[str, str]]] = {}
    for row in rows_of(results / "results.csv") + rows_of(results / "curves.csv"):
        episodes.setdefault(row["unit"], []).append(row)
    found: dict[str, list[tuple[float, float]]] = {}
    for times in rows_of(results / "times.csv"):
        rows = episodes[times["unit"]]
        frames, decisions = (sum(int(row[column]) for row in rows) for column in ("frames", "decisions"))
        seconds = float(times["training_seconds"]) + float(times["evaluation_seconds"])
        agent = rows[0]["agent"].partition("-")[0]
        found.setdefault(agent, []).append((frames / len(rows) / longest, seconds / decisions))
    return found


# The command


def number(kind: type[int] | type[float], least: float, most: float = math.inf) -> Callable[[str], float]:
    """A type of argparse: numbers from `least` to `most`."""

    def parse(text: str) -> float:
        try:
            value = kind(text)
        except ValueError:
            value = math.nan
        if not least <= value <= most or math.isinf(value):
            bounds = f"from {least:g} on" if math.isinf(most) else f"from {least:g} to {most:g}"
            raise argparse.ArgumentTypeError(f"it is {text!r}; it takes a {'whole ' * (kind is int)}number {bounds}")
        return value

    return parse


def summary(units: Sequence[Sequence[float]], cluster: Cluster, shards: int) -> list[Run]:
    """A simulation for each of `units`, in the order of their time."""
    return sorted(
        (simulate(lengths, cluster, shards, seed) for seed, lengths in enumerate(units)), key=lambda run: run.elapsed
    )


def percentile(runs: Sequence[Run], share: float) -> float:
    """The nearest rank: the least time within which at least `share` of the runs end. `runs` are in that order."""
    rank = math.ceil(round(share * len(runs), 6))  # 0.07 * 100 is more than 7
    return runs[max(rank, 1) - 1].elapsed


def fewest_nodes(units: Sequence[Sequence[float]], cluster: Cluster, shards: int, within: float) -> int | None:
    """Returns the number with which 95 % of the simulations take at most `within` seconds.

    Returns None if no number is enough.
    """

    def is_enough(nodes: int) -> bool:
        return percentile(summary(units, replace(cluster, nodes=nodes), shards), 0.95) <= within

    low, high = 0, 1
    while not is_enough(high):
        if high * cluster.cores > max(map(len, units)):
            return None
        low, high = high, 2 * high
    while high - low > 1:
        middle = (low + high) // 2
        low, high = (low, middle) if is_enough(middle) else (middle, high)
    return high


def parse_arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("plan")
    parser.add_argument("--nodes", type=number(int, 1), nargs="+", default=[], help="numbers of nodes to simulate")
    parser.add_argument("--within", type=number(float, 0), metavar="HOURS", help="find the number of nodes")
    parser.add_argument("--cores", type=number(int, 1), default=64, help="cores per node (default 64)")
    parser.add_argument("--shards", type=number(int, 0), default=0, help="tasks (default: a task a unit)")
    parser.add_argument(
        "--longest-first", action="store_true", help="not in the order of the plan, as with a plan for each agent"
    )
    parser.add_argument("--pilot", type=pathlib.Path, metavar="RESULTS")
    parser.add_argument("--failures", type=number(float, 0), default=4, help="failures per node and year (default 4)")
    parser.add_argument("--repair", type=number(float, 0), default=3600, help="seconds (default 3600)")
    parser.add_argument("--requeue", type=number(float, 0), default=120, help="seconds (default 120)")
    parser.add_argument("--checkpoint", type=number(float, 1), default=60, help="seconds (default 60)")
    parser.add_argument(
        "--slow", type=number(float, 0, 1), default=0.05, help="share of nodes that are slow (default 0.05)"
    )
    parser.add_argument(
        "--slowness", type=number(float, 1), default=2, help="how many times slower slow nodes are (default 2)"
    )
    parser.add_argument("--runs", type=number(int, 1), default=20, help="simulations (default 20)")
    parser.add_argument(
        "--program",
        default="racebeam",
        help="program that says how long units take: a name in the PATH, or a path (default: %(default)s)",
    )
    return parser.parse_args()


def units_of(options: argparse.Namespace) -> list[list[float]]:
    """Seconds of all units, for each of the simulations. Ends the program with a sentence if they cannot be known."""
    try:
        agents, measured = agents_of(dry_run_of(options)), pilot_of(options.pilot) if options.pilot else {}
    except OSError as error:
        sys.exit(f"simulate.py: cannot read {error.filename}: {error.strerror}; --pilot takes a folder of results")
    except ValueError as error:
        sys.exit(f"simulate.py: {error}")
    units = [lengths_of(agents, measured, random.Random(seed)) for seed in range(options.runs)]
    return [sorted(lengths, reverse=True) for lengths in units] if options.longest_first else units


def dry_run_of(options: argparse.Namespace) -> str:
    """Returns what `racebeam experiment --dry-run` prints of the plan. Exits with a sentence if racebeam fails."""
    try:
        done = subprocess.run(
            [options.program, "experiment", options.plan, "--dry-run", "--unmeasured"], capture_output=True, text=True
        )
    except OSError as error:
        place = options.program if "/" in options.program else f"{options.program}, looked for in the PATH"
        sys.exit(
            f"simulate.py needs the program racebeam; it cannot start {place}: {error.strerror}; "
            "--program takes its path"
        )
    if done.returncode != 0:
        sys.exit(done.stderr.strip())
    return done.stdout


def main() -> None:
    options = parse_arguments()
    units = units_of(options)
    times = {field.name: getattr(options, field.name) for field in fields(Cluster) if field.name != "nodes"}
    cluster = Cluster(nodes=1, **times)
    work = statistics.median(map(sum, units)) / 3600
    print(f"{len(units[0])} units, {work:.1f} core-hours, longest unit {max(map(max, units)) / 3600:.1f} hours")
    nodes = list(options.nodes)
    if options.within is not None:
        fewest = fewest_nodes(units, cluster, options.shards, options.within * 3600)
        if fewest is None:
            sys.exit(f"no number of nodes is enough for {options.within:g} hours")
        nodes.append(fewest)
    print_table(units, cluster, nodes, options.shards)


def print_table(units: Sequence[Sequence[float]], cluster: Cluster, nodes: Sequence[int], shards: int) -> None:
    """A row for each number of nodes."""
    print(f"{'nodes':>6}{'cores':>7}{'hours':>8}{'95 %':>8}{'busy':>7}{'lost':>8}{'failures':>10}")
    for count in nodes:
        runs = summary(units, replace(cluster, nodes=count), shards)
        cores, elapsed = count * cluster.cores, percentile(runs, 0.5)
        busy = statistics.median(run.busy / run.elapsed / cores for run in runs)
        print(
            f"{count:6}{cores:7}{elapsed / 3600:8.1f}{percentile(runs, 0.95) / 3600:8.1f}{busy:7.0%}"
            f"{statistics.median(run.lost for run in runs) / 3600:8.2f}"
            f"{statistics.median(run.failures for run in runs):10.0f}"
        )


if __name__ == "__main__":
    main()
