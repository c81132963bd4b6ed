#!/usr/bin/env python3
"""Gathers the figures of a plan's results into a small file that the tree keeps, for scripts/measure/paper_results.py.

    plan_figures.py FOLDER/PLAN [--into FILE]

FOLDER/PLAN is what `racebeam experiment PLAN --into FOLDER/PLAN` makes, or a part of it: figures are of the units that
are finished. FOLDER may have besides:

    machine.txt             lines "KEY: VALUE": where and with what the plan was run
    PLAN.checked            units, digests of their rows, and who confirmed them: scripts/measure/paper_plans
    PLAN.verify             what `racebeam verify` printed for each part; after each, a line "processor seconds: N"
    PLAN.ale                what `scripts/check/verify-with-ale` printed for each part
    bench/GAME-search.json  what `racebeam bench --rom GAME --frame-skip 5 --search --json` printed
    bench/GAME-none-N.json  what `racebeam bench --rom GAME --frame-skip N --screen none --json` printed, N being 1 and
    5

FILE is docs/results/figures/PLAN.json unless it is named.
"""

import argparse
import collections
import csv
import hashlib
import json
import pathlib
import re
import statistics
import sys

import tomllib

ROOT = pathlib.Path(__file__).resolve().parents[2]
FIGURES = ROOT / "docs/results/figures"
PARTS = ("training", "evaluation")
CHECKERS = ("verify", "ale")
DIGITS = 16  # of a digest of rows
MOST_NAMED = 10  # units


def table(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


class Results:
    """The results of one plan. Rows of trials that diverged are counted, and left out of all else."""

    def __init__(self, folder):
        if not (folder / "results.csv").exists():
            sys.exit(f"plan_figures.py: {folder} has no results: `racebeam experiment` makes them")
        self.folder = folder
        self.plan = tomllib.loads((folder / "plan.toml").read_text())
        rows = table(folder / "results.csv")
        self.rows = [row for row in rows if row["end"] != "diverged"]
        self.diverged = len(rows) - len(self.rows)
        self.times = {
            row["unit"]: {name: float(value) for name, value in row.items() if name != "unit"}
            for row in table(folder / "times.csv")
        }
        self.agents = list(dict.fromkeys(row["agent"] for row in self.rows))

    def beside(self, name):
        """The text of a file beside the folder of results, or nothing."""
        path = self.folder.parent / name
        return path.read_text() if path.exists() else None

    def trials(self, agent):
        """{game: [score of each trial]}: the means of the trials' episodes."""
        trials = {}
        for row in self.rows:
            if row["agent"] == agent:
                trials.setdefault(row["game"], {}).setdefault(row["trial"], []).append(float(row["score"]))
        return {game: [statistics.mean(scores) for scores in each.values()] for game, each in trials.items()}

    def scores(self, agent):
        """{game: score}: the mean over trials of the mean over their episodes."""
        return {game: statistics.mean(scores) for game, scores in self.trials(agent).items()}

    def errors(self, agent):
        """{game: standard error of the mean over episodes}, of an agent with one trial in each game."""
        episodes = {}
        for row in self.rows:
            if row["agent"] == agent:
                episodes.setdefault(row["game"], []).append(float(row["score"]))
        return {game: statistics.stdev(each) / len(each) ** 0.5 for game, each in episodes.items() if len(each) > 1}

    def distinct(self, agent):
        """{game: the different scores of its episodes, in order}."""
        scores = {}
        for row in self.rows:
            if row["agent"] == agent:
                scores.setdefault(row["game"], set()).add(float(row["score"]))
        return {game: sorted(each) for game, each in scores.items()}

    def curves(self):
        """{agent: {game: [the scores of training of each trial, by tenths of the episodes]}}."""
        path = self.folder / "curves.csv"
        scores = {}
        for row in table(path) if path.exists() else []:
            scores.setdefault((row["agent"], row["game"]), {}).setdefault(row["trial"], []).append(float(row["score"]))
        curves = {}
        for (agent, game), trials in scores.items():
            curves.setdefault(agent, {})[game] = [tenths(each) for each in trials.values()]
        return curves

    def settings(self, agent):
        """The settings of an agent, or of all agents of its kind: const_noop has those of const."""
        agents = self.plan["agent"]
        return agents.get(agent) or agents[agent.split("_")[0]]

    def speeds(self, agent):
        """Decisions a second in each game, training and evaluation together."""
        frames, seconds = collections.Counter(), collections.Counter()
        for unit, game in {row["unit"]: row["game"] for row in self.rows if row["agent"] == agent}.items():
            for part in PARTS:
                frames[game] += self.times[unit][part + "_frames"]
                seconds[game] += self.times[unit][part + "_seconds"]
        return {
            game: frames[game] / self.settings(agent)["frame_skip"] / seconds[game] for game in frames if seconds[game]
        }

    def log_bytes(self, agent):
        """Sizes of the logs that are here: units of other machines are kept without."""
        logs = [
            self.folder / "logs" / row["unit"] / f"{row['episode']}.episode"
            for row in self.rows
            if row["agent"] == agent
        ]
        sizes = [log.stat().st_size for log in logs if log.exists()]
        return {"median": statistics.median(sizes), "largest": max(sizes)} if sizes else None

    def searches(self):
        """An entry for each episode of an agent that searches."""
        return [
            {
                "agent": row["agent"],
                "game": row["game"],
                "score": float(row["score"]),
                "decisions": int(row["decisions"]),
                "seconds": times["evaluation_seconds"],
                "searched_frames": times["searched_frames"],
            }
            for row in self.rows
            if (times := self.times[row["unit"]])["searched_frames"]
        ]

    def machine(self):
        text = self.beside("machine.txt")
        return dict(line.split(": ", 1) for line in text.splitlines()) if text else {}

    def verified(self):
        text = self.beside(f"{self.folder.name}.verify")
        if text is None:
            return None
        names = ("confirmed", "wrong", "not_checked", "frames")
        counts = sums(r"(\d+) rows confirmed, (\d+) wrong, (\d+) could not be checked; (\d+) frames", text)
        (seconds,) = sums(r"processor seconds: ([0-9.]+)", text)
        return {**dict(zip(names, map(int, counts))), "seconds": seconds, "bench_seconds": self.bench_seconds()}

    def checked(self):
        """A dictionary of how many of the present rows each program confirmed. It also names the units that ALE has not
        played, if they are few. None if the plan has no such file."""
        text = self.beside(f"{self.folder.name}.checked")
        if text is None:
            return None
        rows = collections.Counter(row["unit"] for row in self.rows)
        confirmed = {checker: set() for checker in CHECKERS}
        for unit, digest, *checkers in map(str.split, text.splitlines()):
            if rows[unit] and digest == self.digest(unit):
                for checker in checkers:
                    confirmed[checker].add(unit)
        unplayed = [unit for unit in rows if unit not in confirmed["ale"]]
        counts = {checker: sum(rows[unit] for unit in units) for checker, units in confirmed.items()}
        return {**counts, "unplayed": unplayed if len(unplayed) <= MOST_NAMED else []}

    def digest(self, unit):
        """The digest of a unit's rows, as PLAN.checked has it."""
        return hashlib.sha256((self.folder / f"units/{unit}.results.csv").read_bytes()).hexdigest()[:DIGITS]

    def bench_seconds(self):
        """How long the bench would take for the same frames, with the same decisions; None if a game was not
        measured."""
        frames = collections.Counter()
        for row in self.rows:
            frames[row["game"], self.settings(row["agent"])["frame_skip"]] += int(row["frames"])
        speeds = {key: self.bench(key[0], f"none-{key[1]}") for key in frames}
        return sum(frames[key] / speed for key, speed in speeds.items()) if all(speeds.values()) else None

    def ale(self):
        text = self.beside(f"{self.folder.name}.ale")
        if text is None:
            return None
        counts = sums(r"(\d+) rows agree with ALE, (\d+) do not, (\d+) have no image", text)
        return dict(zip(("agree", "differ", "no_image"), map(int, counts)))

    def bench(self, game, kind):
        text = self.beside(f"bench/{game}-{kind}.json")
        return json.loads(text)["frames_per_second"] if text else None

    def figures(self):
        curves = self.curves()
        return {
            "machine": self.machine(),
            "games": self.plan["games"],
            "settings": {agent: self.settings(agent) for agent in self.plan["agents"]},
            "units": len(self.times),
            "unfinished": (self.folder / "work").exists(),
            "episodes": {
                agent: dict(collections.Counter(row["game"] for row in self.rows if row["agent"] == agent))
                for agent in self.agents
            },
            "diverged": self.diverged,
            "seconds": sum(times[part + "_seconds"] for times in self.times.values() for part in PARTS),
            "scores": {agent: self.scores(agent) for agent in self.agents},
            "errors": {agent: self.errors(agent) for agent in self.agents if agent.startswith(("random", "perturb"))},
            "distinct": {agent: self.distinct(agent) for agent in self.agents if agent.startswith("const")},
            "trials": {agent: self.trials(agent) for agent in curves},
            "curves": curves,
            "speeds": {agent: self.speeds(agent) for agent in self.agents},
            "log_bytes": {agent: sizes for agent in self.agents if (sizes := self.log_bytes(agent))},
            "searches": self.searches(),
            "bench": {
                name: {
                    game: speed
                    for game in self.plan["games"]
                    if self.bench(game, "search") and (speed := self.bench(game, kind))
                }
                for name, kind in (("search", "search"), ("none", "none-5"))
            },
            "verified": self.verified(),
            "ale": self.ale(),
            "checked": self.checked(),
        }


def sums(pattern, text):
    """The sum of each group of a pattern over all of its matches."""
    return [sum(map(float, column)) for column in zip(*(match.groups() for match in re.finditer(pattern, text)))]


def tenths(scores):
    """The means of ten equal parts of a list, or of its single members if there are fewer."""
    count = min(10, len(scores))
    ends = [len(scores) * part // count for part in range(count + 1)]
    return [statistics.mean(scores[begin:end]) for begin, end in zip(ends, ends[1:])]


def rounded(value):
    """The value with its numbers cut to six significant digits, so that the file is small."""
    if isinstance(value, dict):
        return {name: rounded(each) for name, each in value.items()}
    if isinstance(value, list):
        return [rounded(each) for each in value]
    return float(f"{value:.6g}") if isinstance(value, float) else value


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--into", type=pathlib.Path)
    options = parser.parse_args()
    into = options.into or FIGURES / f"{options.folder.name}.json"
    text = json.dumps(rounded(Results(options.folder).figures()), indent=1) + "\n"
    into.parent.mkdir(parents=True, exist_ok=True)
    into.write_text(text)


if __name__ == "__main__":
    main()
