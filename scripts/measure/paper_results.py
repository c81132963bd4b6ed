#!/usr/bin/env python3
"""Writes docs/results.md from folders of results, so that no figure is typed by hand.

    paper_results.py FOLDER [--into FILE]

FOLDER has a folder of results for each plan of PLANS, as `racebeam experiment PLAN --into FOLDER/PLAN` makes it. Beside
these it may have, and a section of the document is about each:

    machine.txt             lines "KEY: VALUE": where and with what the plans were run
    PLAN.verify             what `racebeam verify FOLDER/PLAN` printed; then a line "processor seconds: N"
    PLAN.ale                what `scripts/check/verify-with-ale FOLDER/PLAN` printed
    bench/GAME-search.json  what `racebeam bench --rom GAME --frame-skip 5 --search --json` printed
    bench/GAME-none.json    what `racebeam bench --rom GAME --frame-skip 5 --screen none --json` printed

A plan without results that are whole is said to be not run yet. Published scores are those of evaluation/.
"""

import argparse
import collections
import csv
import json
import pathlib
import re
import statistics
import sys
import textwrap
import tomllib

ROOT = pathlib.Path(__file__).resolve().parents[2]
PUBLISHED = ROOT / "evaluation/racebeam_evaluation/data"
WIDTH = 100

PLANS = ("baselines", "hour", "basic", "uct", "uct10", "uct50", "uct150", "full_tree", "iw1")
LEARNERS = {"basic": 8000, "lsh": 4000, "disco": 3000, "bass": 1000, "ram": 500}  # decisions a second: the goals
SEARCH_GOALS = {("uct", "boxing"): 95, ("uct", "asterix"): 100000, ("uct", "seaquest"): 2500}
SIMULATIONS = {10: "uct10", 50: "uct50", 150: "uct150", 500: "uct"}


def table(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def published(name):
    """{game: {agent: score}} of a file of published scores; a score that lacks is left out."""
    rows = {row.pop("game"): row for row in table(PUBLISHED / f"{name}.csv")}
    return {game: {agent: float(score) for agent, score in row.items() if score} for game, row in rows.items()}


def paper():
    learners, planners, successors = map(published, ("paper2013/learners", "paper2013/planners", "successors"))
    return {game: learners[game] | planners[game] | successors.get(game, {}) for game in learners}


class Results:
    """The results of one plan."""

    def __init__(self, folder):
        self.folder = folder
        self.plan = tomllib.loads((folder / "plan.toml").read_text())
        self.rows = [row for row in table(folder / "results.csv") if row["end"] != "diverged"]
        self.diverged = len(table(folder / "results.csv")) - len(self.rows)
        self.times = {row["unit"]: {name: float(value) for name, value in row.items() if name != "unit"}
                      for row in table(folder / "times.csv")}

    def scores(self, agent):
        """{game: score}: the mean over trials of the mean over their episodes."""
        trials = {}
        for row in self.rows:
            if row["agent"] == agent:
                trials.setdefault(row["game"], {}).setdefault(row["trial"], []).append(float(row["score"]))
        return {game: statistics.mean(map(statistics.mean, each.values())) for game, each in trials.items()}

    def best(self, kind):
        """{game: (score, action)} of the best of the 18 agents of a kind."""
        found = {}
        for agent in dict.fromkeys(row["agent"] for row in self.rows if row["agent"].startswith(kind + "_")):
            for game, score in self.scores(agent).items():
                if game not in found or score > found[game][0]:
                    found[game] = score, agent.removeprefix(kind + "_")
        return found

    def seconds(self):
        return sum(times["training_seconds"] + times["evaluation_seconds"] for times in self.times.values())

    def speeds(self, agent):
        """Decisions a second of each game, training and evaluation."""
        skip = self.plan["agent"][agent]["frame_skip"]
        frames, seconds = collections.Counter(), collections.Counter()
        for unit, game in {row["unit"]: row["game"] for row in self.rows if row["agent"] == agent}.items():
            for part in ("training", "evaluation"):
                frames[game] += self.times[unit][part + "_frames"]
                seconds[game] += self.times[unit][part + "_seconds"]
        return {game: frames[game] / skip / seconds[game] for game in frames}

    def log_sizes(self, agents):
        return [(self.folder / "logs" / row["unit"] / f"{row['episode']}.episode").stat().st_size
                for row in self.rows if row["agent"] in agents]


def number(value, digits=1):
    return f"{value:,.{digits}f}" if value is not None else "-"


def rows_of(header, *rows):
    """A Markdown table. The columns of numbers are aligned to the right."""
    numeric = [all(re.fullmatch(r"-|[-0-9.,]+%?", row[i]) for row in rows) for i in range(len(header))]
    lines = [header, ["---:" if each else "---" for each in numeric], *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def prose(text):
    return textwrap.fill(" ".join(text.split()), WIDTH, break_long_words=False, break_on_hyphens=False)


class Document:
    def __init__(self, folder):
        self.folder = folder
        self.results = {name: Results(folder / name) for name in PLANS
                        if (folder / name / "results.csv").exists() and not (folder / name / "work").exists()}
        self.paper = paper()
        self.parts = []

    def add(self, *parts):
        self.parts += parts

    def say(self, text):
        self.add(prose(text))

    def lacks(self, *names):
        """Says which of the plans were not run, and returns whether one was not."""
        missing = [name for name in names if name not in self.results]
        for name in missing:
            self.say(f"Not run yet: `racebeam experiment {name}`.")
        return bool(missing)

    def text(self):
        self.introduction()
        self.conditions()
        self.scale()
        self.differences()
        self.baselines()
        self.learners()
        self.long_training()
        self.searches()
        self.simulations()
        self.verification()
        self.logs()
        return "\n\n".join(self.parts) + "\n"

    def introduction(self):
        self.add("# Results of the paper's benchmark")
        self.say("""This document has the scores that racebeam's agents reach, beside those that were published. `scripts/measure/paper_results.py`
            writes it from folders of results; no figure is typed by hand. "The paper" is Bellemare et al. 2013. Where it is
            silent, [paper-notes.md](paper-notes.md) says what racebeam does.""")

    def conditions(self):
        self.add("## Commands, machine, versions")
        machine = self.folder / "machine.txt"
        if machine.exists():
            self.add(rows_of(["what", "value"], *(line.split(": ", 1) for line in machine.read_text().splitlines())))
        self.say("""The plans are part of the program. Each was run by `racebeam experiment PLAN --into FOLDER/PLAN --roms DIR`. Times are
            seconds of processor time, so that other programs hardly change them.""")
        rows = []
        for name in PLANS:
            found = self.results.get(name)
            rows.append([f"`{name}`", *([f"{len(found.times):,}", f"{len(found.rows):,}", str(found.diverged),
                                         number(found.seconds() / 3600, 2)] if found else ["not run yet", "-", "-", "-"])])
        self.add(rows_of(["plan", "units", "episodes", "trials that diverged", "core-hours"], *rows))

    def scale(self):
        self.add("## What was scaled down")
        self.say("""The plan `paper` has the paper's whole benchmark. `racebeam experiment paper --dry-run` prints what it costs. The figures
            of this document are from smaller plans:""")
        self.add(rows_of(
            ["part", "paper", "here", "what that can show", "what it cannot show"],
            ["baselines", "55 games; number of episodes not printed", "55 games, 30 episodes", "the paper's columns",
             "differences below the spread of 30 episodes"],
            ["learners", "55 games, 30 trials of 5,000 episodes", "5 games, 2 trials of 200,000 decisions",
             "that each learner learns", "scores of whole training; tests between learners"],
            ["Basic, longer", "5,000 episodes, 30 trials", "2,000,000 decisions, 1 trial", "scores of long training",
             "the spread over trials"],
            ["UCT, full tree", "55 games, 10 episodes", "3 games and 1 game, 1 episode", "the budget's strength and cost",
             "means; other games"],
            ["IW(1)", f"{sum('iw1' in scores for scores in self.paper.values())} games", "2 games, 1 episode", "the same", "the same"]))

    def differences(self):
        self.add("## Why figures differ from the published ones")
        self.add("\n".join(textwrap.fill("- " + " ".join(text.split()), WIDTH, subsequent_indent="  ") for text in (
            """The emulator: the paper used ALE of 2012. racebeam is exact to ALE 0.12, whose emulator and games' rules have changed
            since.""",
            """Starts: each episode begins at power-on with a seed of its own, and without the human trajectories and NOOPs that
            others used. Games that draw nothing from their seed give a policy without chance the same episode each time.""",
            """Rewards: some rules differ. Skiing's rewards were near 0 then, and add up to about -17,000 for random play now.
            Its row cannot be compared.""",
            """Choices: the paper leaves much open ([paper-notes.md](paper-notes.md)).""")))

    def baselines(self):
        self.add("## Baselines")
        if self.lacks("baselines"):
            return
        found = self.results["baselines"]
        random, const, perturb = found.scores("random"), found.best("const"), found.best("perturb")
        rows = []
        for game in found.plan["games"]:
            theirs = self.paper.get(game, {})
            rows.append([game, number(random[game]), number(theirs.get("random")),
                         number(const[game][0]), const[game][1], number(theirs.get("const")),
                         number(perturb[game][0]), perturb[game][1], number(theirs.get("perturb"))])
        near = [game for game in random if game != "skiing" and game in self.paper and
                abs(random[game] - self.paper[game]["random"]) <= abs(self.paper[game]["random"]) / 5]
        self.say(f"""Means of {found.plan['agent']['random']['evaluation_episodes']} episodes. Const and Perturb are the best of 18 policies, with
            its action. In {len(near)} of {len(random)} games, the score of Random is within a fifth of the paper's.""")
        self.add(rows_of(["game", "Random", "paper", "Const", "action", "paper's Const", "Perturb", "action of Perturb", "paper's Perturb"],
                         *rows))

    def learners(self):
        self.add("## Learners, in an hour")
        if self.lacks("hour"):
            return
        found = self.results["hour"]
        agents = [agent for agent in found.plan["agents"] if agent in LEARNERS]
        random = found.scores("random")
        scores = {agent: found.scores(agent) for agent in agents}
        trial = found.plan["agent"][agents[0]]
        self.say(f"""{trial['trials']} trials of {trial['training_frames'] // trial['frame_skip']:,} decisions and
            {trial['evaluation_episodes']} evaluation episodes each. All took {number(found.seconds() / 7200, 2)} hours of processor time on
            each of two cores (goal: 1, at most 1.5), the discovery of backgrounds and classes not included. In brackets: the paper's
            scores, after 5,000 episodes.""")
        self.add(rows_of(["game", "Random", *agents], *(
            [game, f"{number(random[game])} ({number(self.paper[game]['random'])})",
             *(f"{number(scores[agent].get(game))} ({number(self.paper[game][agent])})" for agent in agents)]
            for game in found.plan["games"])))
        self.say("Games in which each learner is better than Random (goal: at least three), and its speed, emulation included:")
        speeds = {agent: found.speeds(agent) for agent in agents}
        self.add(rows_of(["learner", "games above Random", "decisions a second, mean of the games", "lowest", "highest", "goal"], *(
            [agent, str(sum(scores[agent].get(game, random[game]) > random[game] for game in random)),
             number(statistics.mean(speeds[agent].values()), 0), number(min(speeds[agent].values()), 0),
             number(max(speeds[agent].values()), 0), number(LEARNERS[agent], 0)] for agent in agents)))
        if (ROOT / "docs/pictures/learning-curves.svg").exists():
            self.add("![Scores of training episodes by frames, a panel for each game](pictures/learning-curves.svg)")

    def long_training(self):
        self.add("## Basic, for 2,000,000 decisions")
        if self.lacks("basic"):
            return
        found = self.results["basic"]
        scores, random = found.scores("basic"), found.scores("random")
        self.add(rows_of(["game", "Basic", "paper's Basic", "Random"], *(
            [game, number(scores.get(game)), number(self.paper[game]["basic"]), number(random[game])]
            for game in found.plan["games"])))

    def searches(self):
        self.add("## Search")
        rows = []
        seconds_of_uct = []
        for name in ("uct", "full_tree", "iw1"):
            if self.lacks(name):
                continue
            found = self.results[name]
            for row in found.rows:
                times = found.times[row["unit"]]
                seconds = times["evaluation_seconds"] / int(row["decisions"])
                if name == "uct":
                    seconds_of_uct.append(seconds)
                speed = times["searched_frames"] / times["evaluation_seconds"]
                bench = self.bench(row["game"], "search")
                goal = SEARCH_GOALS.get((name, row["game"]))
                rows.append([name, row["game"], number(float(row["score"])), number(self.paper[row["game"]].get(name)),
                             number(goal, 0), f"{int(row['decisions']):,}", number(seconds, 2), number(speed, 0),
                             number(speed / bench, 2) if bench else "-"])
        if rows:
            self.say("""One episode each, at the full budget of a decision. The last column compares with
                `racebeam bench --search --frame-skip 5`.""")
            self.add(rows_of(["agent", "game", "score", "published", "goal", "decisions", "seconds a decision", "frames a second",
                              "of the bench"], *rows))
        if seconds_of_uct:
            self.say(f"""UCT takes {number(statistics.mean(seconds_of_uct), 2)} seconds a decision in the mean (goal: at most 1; the paper's
                took 15).""")

    def bench(self, game, kind):
        path = self.folder / f"bench/{game}-{kind}.json"
        return json.loads(path.read_text())["frames_per_second"] if path.exists() else None

    def simulations(self):
        self.add("## UCT: score against simulations")
        if self.lacks(*(name for name in SIMULATIONS.values() if name != "uct")) or "uct" not in self.results:
            return
        self.say("Means of the episodes, whose number is in brackets.")
        each = {count: self.results[name] for count, name in SIMULATIONS.items()}
        games = self.results[SIMULATIONS[10]].plan["games"]
        self.add(rows_of(["game", *(f"{count} simulations" for count in each)], *(
            [game, *(f"{number(found.scores('uct').get(game))} ({sum(row['game'] == game for row in found.rows)})"
                     for found in each.values())] for game in games)))

    def verification(self):
        self.add("## Verification")
        self.say("""`racebeam verify` plays each episode again from its log. It confirms score, frames, end and state hashes. That proves
            that these actions give this score, not which agent chose them ([episodes.md](episodes.md)).
            `scripts/check/verify-with-ale` plays the same logs in ALE.""")
        rows = []
        for name, found in self.results.items():
            path = self.folder / f"{name}.verify"
            if not path.exists():
                continue
            printed = path.read_text()
            counts = re.search(r"(\d+) rows confirmed, (\d+) wrong, (\d+) could not be checked; (\d+) frames", printed)
            seconds = float(re.search(r"processor seconds: ([0-9.]+)", printed)[1])
            ale = self.folder / f"{name}.ale"
            agreed = re.search(r"(\d+) rows agree with ALE, (\d+) do not, (\d+) have no image", ale.read_text()) if ale.exists() else None
            rows.append([f"`{name}`", *(f"{int(count):,}" for count in counts.groups()[:3]), number(int(counts[4]) / seconds, 0),
                         number(100 * seconds / found.seconds(), 1) + "%",
                         f"{int(agreed[1]):,}" if agreed else "-", f"{int(agreed[2]):,}" if agreed else "-"])
        if not rows:
            self.say("Not run yet.")
            return
        self.add(rows_of(["plan", "confirmed", "wrong", "not checked", "frames a second and core", "of the time of the run",
                          "ALE agrees", "ALE does not"], *rows))
        none = {path.name.split("-")[0]: self.bench(path.name.split("-")[0], "none")
                for path in sorted(self.folder.glob("bench/*-none.json"))}
        if none:
            self.say("`racebeam bench --screen none --frame-skip 5`, frames a second: " +
                     ", ".join(f"{game} {number(speed, 0)}" for game, speed in none.items()) + ".")

    def logs(self):
        self.add("## Logs")
        rows = []
        for name, agents, goal, measure in (("baselines", ("random",), "at most 12,288", max),
                                            ("hour", tuple(LEARNERS), "under 2,048", statistics.median)):
            if name in self.results:
                sizes = self.results[name].log_sizes(agents)
                rows.append([f"`{name}`", ", ".join(agents), {max: "largest", statistics.median: "median"}[measure],
                             number(measure(sizes), 0), goal])
        if rows:
            self.add(rows_of(["plan", "agents", "size of", "bytes", "goal"], *rows))
        else:
            self.say("Not run yet.")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--into", type=pathlib.Path, default=ROOT / "docs/results.md")
    options = parser.parse_args()
    if not options.folder.is_dir():
        sys.exit(f"paper_results.py: there is no folder {options.folder}")
    options.into.write_text(Document(options.folder).text())


if __name__ == "__main__":
    main()
