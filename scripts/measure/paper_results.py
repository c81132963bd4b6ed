#!/usr/bin/env python3
"""Writes docs/results.md from the figures of docs/results/figures, so that no figure is typed by hand.

    paper_results.py [FOLDER] [--into FILE]

FOLDER has PLAN.json for plans of PLANS, as scripts/measure/plan_figures.py gathers them; docs/results/figures unless it
is named. A plan without figures is said to be not run yet. Where only some games of `baselines` were run again,
baselines-partial.json has these: its plan is that of `baselines` with fewer games. Published scores are those of
evaluation/.
"""

import argparse
import json
import pathlib
import re
import statistics
import sys
import textwrap

from plan_figures import FIGURES, ROOT, table

PUBLISHED = ROOT / "evaluation/racebeam_evaluation/data"
WIDTH = 100

PLANS = ("baselines", "hour", "basic", "disco", "uct", "uct10", "uct50", "uct150", "full_tree", "iw1")
LEARNERS = {"basic": 8000, "lsh": 4000, "disco": 3000, "bass": 1000, "ram": 500}  # decisions a second: the goals
SEARCH_GOALS = {("uct", "boxing"): 95, ("uct", "asterix"): 100000, ("uct", "seaquest"): 2500}
SIMULATIONS = {10: "uct10", 50: "uct50", 150: "uct150", 500: "uct"}
# Agents that have changed: the plan and the agent; whether settings are those of the agent as it is now; what it did.
CHANGED = (
    (
        "baselines",
        "perturb",
        lambda settings: settings["frame_skip"] == 1,
        "an action for 5 frames; now for each frame",
    ),
    (
        "hour",
        "disco",
        lambda settings: "count_instances" in settings,
        "left out objects that hardly move, followed others for 8 pixels a decision, and had two bits for a velocity",
    ),
    (
        "full_tree",
        "full_tree",
        lambda settings: "reuse_tree" in settings,
        "of equal actions, could choose one that ends the episode",
    ),
    (
        "iw1",
        "iw1",
        lambda settings: "reuse_tree" in settings,
        "built its tree anew for each decision, and opened nodes with a reward like others",
    ),
)
PARTIAL = "baselines-partial"
MACHINE = ("processor", "version")  # of machine.txt: what the table of plans shows


def published(name):
    """{game: {agent: score}} of a file of published scores; a score that lacks is left out."""
    rows = {row.pop("game"): row for row in table(PUBLISHED / f"{name}.csv")}
    return {game: {agent: float(score) for agent, score in row.items() if score} for game, row in rows.items()}


def paper():
    learners, planners, successors = map(published, ("paper2013/learners", "paper2013/planners", "successors"))
    return {game: learners[game] | planners[game] | successors.get(game, {}) for game in learners}


def number(value, digits=1):
    return f"{round(value, digits) + 0:,.{digits}f}" if value is not None else "-"  # + 0: not -0.0


def rows_of(header, *rows):
    """A Markdown table. The columns of numbers are aligned to the right."""
    numeric = [all(re.fullmatch(r"-|[-0-9.,]+%?", row[i]) for row in rows) for i in range(len(header))]
    lines = [header, ["---:" if each else "---" for each in numeric], *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def prose(text):
    return textwrap.fill(" ".join(text.split()), WIDTH, break_long_words=False, break_on_hyphens=False)


def episodes(found):
    return sum(count for games in found["episodes"].values() for count in games.values())


def share_of_bench(verified):
    """The speed of the verification beside the bench's; "-" if the bench was not run for all of its games."""
    seconds = verified.get("bench_seconds")
    return number(seconds / verified["seconds"], 2) if seconds else "-"


def best(found, kind):
    """{game: (score, action)} of the best of the 18 agents of a kind."""
    scores = {
        agent.removeprefix(kind + "_"): each for agent, each in found["scores"].items() if agent.startswith(kind + "_")
    }
    return {
        game: max(((each[game], action) for action, each in scores.items() if game in each), key=lambda pair: pair[0])
        for game in found["games"]
    }


class Document:
    def __init__(self, folder):
        self.figures = {
            name: json.loads((folder / f"{name}.json").read_text())
            for name in (*PLANS, PARTIAL)
            if (folder / f"{name}.json").exists()
        }
        self.paper = paper()
        self.parts = []

    def add(self, *parts):
        self.parts += parts

    def say(self, text):
        self.add(prose(text))

    def lacks(self, *names):
        """Says which of the plans were not run, and returns whether one was not."""
        missing = [name for name in names if name not in self.figures]
        for name in missing:
            self.say(f"Not run yet: `racebeam experiment {name}`.")
        return bool(missing)

    def title(self, name):
        """What a table calls a plan."""
        return f"`baselines`, {len(self.figures[name]['games'])} games again" if name == PARTIAL else f"`{name}`"

    def text(self):
        self.introduction()
        self.conditions()
        self.scale()
        self.differences()
        self.changes()
        self.baselines()
        self.learners()
        self.long_training()
        self.disco()
        self.searches()
        self.simulations()
        self.verification()
        self.logs()
        return "\n\n".join(self.parts) + "\n"

    def introduction(self):
        self.add("# Results of the paper's benchmark")
        self.say("""This document has the scores that racebeam's agents reach, beside those that were published.
            `scripts/measure/paper_results.py`
            writes it from figures that `scripts/measure/plan_figures.py` gathered from the results of each plan; no
            figure is typed by hand. "The paper" is Bellemare et al. 2013. Where it is
            silent, [paper-notes.md](paper-notes.md) says what racebeam does.""")

    def conditions(self):
        self.add("## Commands, machine, versions")
        self.say("""The plans are part of the program. `scripts/measure/paper_plans FOLDER PLAN` runs a plan, verifies
            its rows, and gathers its figures. Times are
            seconds of processor time, so that other programs hardly change them.""")
        rows = []
        for name in (*PLANS, *({PARTIAL} & set(self.figures))):
            found = self.figures.get(name)
            rows.append(
                [
                    self.title(name),
                    *(
                        [
                            f"{found['units']:,}",
                            f"{episodes(found):,}",
                            str(found["diverged"]),
                            number(found["seconds"] / 3600, 2),
                            *(found["machine"].get(key, "-") for key in MACHINE),
                        ]
                        if found
                        else ["not run yet", *["-"] * (3 + len(MACHINE))]
                    ),
                ]
            )
        self.add(rows_of(["plan", "units", "episodes", "trials that diverged", "core-hours", *MACHINE], *rows))

    def scale(self):
        self.add("## What was scaled down")
        self.say("""The plan `paper` has the paper's whole benchmark. `racebeam experiment paper --dry-run` prints what
            it costs. The figures
            of this document are from smaller plans:""")
        self.add(
            rows_of(
                ["part", "paper", "here", "what that can show", "what it cannot show"],
                [
                    "baselines",
                    "55 games; number of episodes not printed",
                    "55 games, 30 episodes",
                    "the paper's columns",
                    "differences below the spread of 30 episodes",
                ],
                [
                    "learners",
                    "55 games, 30 trials of 5,000 episodes",
                    "5 games, 2 trials of 200,000 decisions",
                    "that each learner learns",
                    "scores of whole training; tests between learners",
                ],
                [
                    "Basic, longer",
                    "5,000 episodes, 30 trials",
                    "2,000,000 decisions, 1 trial",
                    "scores of long training",
                    "the spread over trials",
                ],
                [
                    "UCT, full tree",
                    "55 games, 10 episodes",
                    "3 games and 1 game, 1 episode",
                    "the budget's strength and cost",
                    "means; other games",
                ],
                [
                    "IW(1)",
                    f"{sum('iw1' in scores for scores in self.paper.values())} games",
                    "2 games, 1 episode",
                    "the same",
                    "the same",
                ],
            )
        )

    def differences(self):
        self.add("## Why figures differ from the published ones")
        self.add(
            "\n".join(
                textwrap.fill("- " + " ".join(text.split()), WIDTH, subsequent_indent="  ")
                for text in (
                    """The emulator: the paper used ALE of 2012. racebeam is exact to ALE 0.12, whose emulator and
                    games' rules have changed
            since.""",
                    """Starts: each episode begins at power-on with its own seed, and without the human
                    trajectories and NOOPs that
            others used. Games that draw nothing from their seed give a policy without chance the same episode each
            time.""",
                    """Rewards: some rules differ. Skiing's rewards were near 0 then, and add up to about -17,000 for
                    random play now.
            Its row cannot be compared.""",
                    """Single episodes: searches play one, so that an early death costs all that would follow.""",
                    """Choices: the paper leaves much open ([paper-notes.md](paper-notes.md)).""",
                )
            )
        )

    def changes(self):
        rows = [
            [f"`{plan}`", agent, then]
            for plan, agent, is_now, then in CHANGED
            if (settings := self.shown(plan).get("settings", {}).get(agent)) and not is_now(settings)
        ]
        if not rows:
            return
        self.add("## Agents that have changed since")
        self.say("""These agents did not do what their authors' do when the plans were run
            ([paper-notes.md](paper-notes.md)). The
            agents are mended; their figures in this document are still those of before. `racebeam experiment` makes
            new ones.""")
        self.add(rows_of(["plan", "agent", "what the agent did"], *rows))

    def shown(self, plan):
        """The figures whose changed agents the document shows."""
        return self.figures.get(f"{plan}-partial", self.figures.get(plan, {}))

    def baselines(self):
        self.add("## Baselines")
        if self.lacks("baselines"):
            return
        found = self.figures["baselines"]
        random, const, perturb = (
            found["scores"]["random"],
            best(found, "const"),
            best(self.shown("baselines"), "perturb"),
        )
        rows = []
        for game in found["games"]:
            theirs = self.paper.get(game, {})
            rows.append(
                [
                    game,
                    number(random[game]),
                    number(theirs.get("random")),
                    number(const[game][0]),
                    const[game][1],
                    number(theirs.get("const")),
                    number(perturb[game][0]) if game in perturb else "-",
                    perturb[game][1] if game in perturb else "-",
                    number(theirs.get("perturb")),
                ]
            )
        near = [
            game
            for game in random
            if game != "skiing"
            and game in self.paper
            and abs(random[game] - self.paper[game]["random"]) <= abs(self.paper[game]["random"]) / 5
        ]
        same = [game for game in const if game in self.paper and const[game][0] == self.paper[game]["const"]]
        self.say(f"""Means of {found["settings"]["random"]["evaluation_episodes"]} episodes. Const and Perturb are the
            best of 18 policies, with
            its action. In {len(near)} of {len(random)} games, the score of Random is within a fifth of the paper's.
            A constant action leaves nothing to chance without sticky actions, so that a difference of Const is one of
            the emulator or of the games' rules: in {len(same)} of {len(const)} games there is none.""")
        self.perturb(perturb, len(found["games"]))
        self.add(
            rows_of(
                [
                    "game",
                    "Random",
                    "paper",
                    "Const",
                    "action",
                    "paper's Const",
                    "Perturb",
                    "action of Perturb",
                    "paper's Perturb",
                ],
                *rows,
            )
        )

    def perturb(self, perturb, games):
        """How near Perturb is to the paper's. It is within a fifth if the scores differ by at most a fifth of it."""
        if PARTIAL in self.figures:
            self.say(f"""Perturb, which chose an action for 5 frames before, has been run again in {len(perturb)} of
                {games} games. The other games have a dash.""")
        far = [
            f"{game} ({number(score)} for {number(theirs)})"
            for game, (score, _) in perturb.items()
            if (theirs := self.paper.get(game, {}).get("perturb")) is not None and abs(score - theirs) > abs(theirs) / 5
        ]
        self.say(f"""Perturb's score is within a fifth of the paper's in {len(perturb) - len(far)} of {len(perturb)}
            games{": not in " + ", ".join(far) if far else ""}.""")

    def learners(self):
        self.add("## Learners, in an hour")
        if self.lacks("hour"):
            return
        found = self.figures["hour"]
        scores = found["scores"]
        agents = [agent for agent in scores if agent in LEARNERS]
        random, trial = scores["random"], found["settings"][agents[0]]
        self.say(f"""{trial["trials"]} trials of {trial["training_frames"] // trial["frame_skip"]:,} decisions and
            {trial["evaluation_episodes"]} evaluation episodes each. All took {number(found["seconds"] / 7200, 2)}
            hours of processor time on
            each of two cores (goal: 1, at most 1.5), the discovery of backgrounds and classes not included. In
            brackets: the paper's
            scores, after 5,000 episodes.""")
        self.add(
            rows_of(
                ["game", "Random", *agents],
                *(
                    [
                        game,
                        f"{number(random[game])} ({number(self.paper[game]['random'])})",
                        *(f"{number(scores[agent].get(game))} ({number(self.paper[game][agent])})" for agent in agents),
                    ]
                    for game in found["games"]
                ),
            )
        )
        self.say(f"""Games in which the mean of each learner is above that of Random (goal: at least three), and its
            speed, emulation included. {trial["trials"]} trials are too few to tell such a difference from chance:
            `racebeam-evaluate` gives the number of games its interval, and tests each game.""")
        speeds = found["speeds"]
        self.add(
            rows_of(
                ["learner", "games above Random", "decisions a second, mean of the games", "lowest", "highest", "goal"],
                *(
                    [
                        agent,
                        str(sum(scores[agent].get(game, random[game]) > random[game] for game in random)),
                        number(statistics.mean(speeds[agent].values()), 0),
                        number(min(speeds[agent].values()), 0),
                        number(max(speeds[agent].values()), 0),
                        number(LEARNERS[agent], 0),
                    ]
                    for agent in agents
                ),
            )
        )
        if (ROOT / "docs/pictures/learning-curves.svg").exists():
            self.add("![Scores of training episodes by frames, a panel for each game](pictures/learning-curves.svg)")

    def long_training(self):
        self.add("## Basic, for 2,000,000 decisions")
        if self.lacks("basic"):
            return
        found = self.figures["basic"]
        scores, random = found["scores"]["basic"], found["scores"]["random"]
        self.add(
            rows_of(
                ["game", "Basic", "paper's Basic", "Random"],
                *(
                    [game, number(scores.get(game)), number(self.paper[game]["basic"]), number(random[game])]
                    for game in found["games"]
                ),
            )
        )

    def disco(self):
        self.add("## DISCO, whole training")
        if self.lacks("disco"):
            return
        found = self.figures["disco"]
        scores, counts = found["scores"]["disco"], found["episodes"]["disco"]
        self.add(
            rows_of(
                ["game", "DISCO", "paper's DISCO", "evaluation episodes"],
                *(
                    [game, number(scores.get(game)), number(self.paper[game]["disco"]), f"{counts.get(game, 0):,}"]
                    for game in found["games"]
                ),
            )
        )

    def searches(self):
        self.add("## Search")
        rows = []
        seconds_of_uct = []
        for name in ("uct", "full_tree", "iw1"):
            if self.lacks(name):
                continue
            found = self.figures[name]
            for episode in found["searches"]:
                game, score = episode["game"], episode["score"]
                seconds = episode["seconds"] / episode["decisions"]
                if name == "uct":
                    seconds_of_uct.append(seconds)
                speed = episode["searched_frames"] / episode["seconds"]
                bench = found["bench"]["search"].get(game)
                rows.append(
                    [
                        name,
                        game,
                        number(score),
                        number(self.paper[game].get(name)),
                        number(SEARCH_GOALS.get((name, game)), 0),
                        f"{episode['decisions']:,}",
                        number(seconds, 2),
                        number(speed, 0),
                        number(speed / bench, 2) if bench else "-",
                    ]
                )
        if rows:
            self.say("""One episode each, at the full budget of a decision. The last column compares with
                `racebeam bench --search --frame-skip 5`.""")
            self.add(
                rows_of(
                    [
                        "agent",
                        "game",
                        "score",
                        "published",
                        "goal",
                        "decisions",
                        "seconds a decision",
                        "frames a second",
                        "of the bench",
                    ],
                    *rows,
                )
            )
        if seconds_of_uct:
            self.say(f"""UCT takes {number(statistics.mean(seconds_of_uct), 2)} seconds a decision in the mean (goal:
            at most 1; the paper's
                took 15).""")

    def simulations(self):
        self.add("## UCT: score against simulations")
        if self.lacks(*(name for name in SIMULATIONS.values() if name != "uct")) or "uct" not in self.figures:
            return
        self.say("Means of the episodes, whose number is in brackets.")
        each = {count: self.figures[name] for count, name in SIMULATIONS.items()}
        games = each[10]["games"]
        self.add(
            rows_of(
                ["game", *(f"{count} simulations" for count in each)],
                *(
                    [
                        game,
                        *(
                            f"{number(found['scores']['uct'].get(game))} ({found['episodes']['uct'].get(game, 0)})"
                            for found in each.values()
                        ),
                    ]
                    for game in games
                ),
            )
        )

    def verification(self):
        self.add("## Verification")
        self.say("""`racebeam verify` plays each episode again from its log. It confirms score, frames, end and state
            hashes. That proves
            that these actions give this score, not which agent chose them ([episodes.md](episodes.md)).
            `scripts/check/verify-with-ale` plays the same logs in ALE. "Of the bench" is the speed beside that of
            `racebeam bench --screen none` for the same games, frames and frame skip; the start of the process
            counts.""")
        rows, none = [], {}
        for name, found in self.figures.items():
            none.setdefault(found["machine"].get("processor", "-"), {}).update(found["bench"]["none"])
            verified, ale = found["verified"], found["ale"] or {}
            if verified:
                rows.append(
                    [
                        self.title(name),
                        *(f"{verified[key]:,}" for key in ("confirmed", "wrong", "not_checked")),
                        number(verified["frames"] / verified["seconds"], 0),
                        share_of_bench(verified),
                        number(100 * verified["seconds"] / found["seconds"], 1) + "%",
                        *(f"{ale[key]:,}" if ale else "-" for key in ("agree", "differ")),
                    ]
                )
        if not rows:
            self.say("Not run yet.")
            return
        unverified = [self.title(name) for name, found in self.figures.items() if not found["verified"]]
        if unverified:
            self.say(f"Not verified yet: {', '.join(unverified)}.")
        self.add(
            rows_of(
                [
                    "plan",
                    "confirmed",
                    "wrong",
                    "not checked",
                    "frames a second and core",
                    "of the bench",
                    "of the time of the run",
                    "ALE agrees",
                    "ALE does not",
                ],
                *rows,
            )
        )
        for processor, speeds in none.items():
            if speeds:
                self.say(
                    f"`racebeam bench --screen none --frame-skip 5` on {processor}, frames a second: "
                    + ", ".join(f"{game} {number(speed, 0)}" for game, speed in speeds.items())
                    + "."
                )

    def logs(self):
        self.add("## Logs")
        rows = []
        for name, agents, measure, goal in (
            ("baselines", ("random",), "largest", "at most 12,288"),
            ("hour", tuple(LEARNERS), "median", "under 2,048"),
        ):
            sizes = self.figures[name]["log_bytes"] if name in self.figures else {}
            rows += [
                [f"`{name}`", agent, measure, number(sizes[agent][measure], 0), goal]
                for agent in agents
                if agent in sizes
            ]
        if rows:
            self.add(rows_of(["plan", "agent", "size of", "bytes", "goal"], *rows))
        else:
            self.say("Not run yet.")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("folder", type=pathlib.Path, nargs="?", default=FIGURES)
    parser.add_argument("--into", type=pathlib.Path, default=ROOT / "docs/results.md")
    options = parser.parse_args()
    if options.folder != FIGURES and not options.folder.is_dir():
        sys.exit(f"paper_results.py: the folder {options.folder} does not exist")
    options.into.write_text(Document(options.folder).text())


if __name__ == "__main__":
    main()
