"""The parts of docs/results.md: paragraphs, tables, and the figures that they show."""

import json
import re
import statistics
import textwrap

from plan_figures import ROOT, table

from .student import bounds

PUBLISHED = ROOT / "evaluation/racebeam_evaluation/data"
WIDTH = 100
PLANS = (
    *("baselines", "perturb", "hour", "basic", "learners", "ram", "blob_prost"),
    *("uct", "uct10", "uct50", "uct150", "full_tree", "iw1", "searches"),
)
FULL_SEARCHES = ("uct", "full_tree", "iw1", "searches")  # with the whole budget of a decision
AGAIN = {  # other episodes of the policies whose score is not the paper's
    "random-again": "Random, other episodes",
    "const-again": "Const, other starts",
    "perturb-again": "Perturb, other episodes",
}
SAMPLES = {"perturb-sample": "perturb"}  # units of a plan that were run again, for ALE to play their logs


def published(name):
    """{game: {agent: score}} of a file of published scores; a score that lacks is left out."""
    rows = {row.pop("game"): row for row in table(PUBLISHED / f"{name}.csv")}
    return {game: {agent: float(score) for agent, score in row.items() if score} for game, row in rows.items()}


def paper():
    learners, planners, successors = map(published, ("paper2013/learners", "paper2013/planners", "successors"))
    return {game: learners[game] | planners[game] | successors.get(game, {}) for game in learners}


def published_training():
    """{agent: how long the agent with published scores was trained}, such as "5,000 episodes"."""
    return {row["agent"]: row["training"] for row in table(PUBLISHED / "protocols.csv")}


def known_cause(game, agent):
    """Why a score differs from the published one, or cannot be compared, as experiments have shown; None: unknown."""
    for name, column, prefix in (("not_comparable", "reason", "not comparable: "), ("causes", "cause", "")):
        for row in table(PUBLISHED / f"{name}.csv"):
            if row["game"] == game and row["agent"] in (agent, "*"):
                return prefix + row[column]
    return None


def number(value, digits=1):
    return f"{round(value, digits) + 0:,.{digits}f}" if value is not None else "-"  # + 0: not -0.0


def agreement(sample, theirs, unit):
    """Whether a published score is within the interval of ours; "-" if nobody published one."""
    if theirs is None:
        return "-"
    if statistics.mean(sample) == theirs:
        return "yes"
    within = bounds(sample)
    if within is None:
        return f"unknown: one {unit} has no interval"
    return "yes" if within[0] <= theirs <= within[1] else "no"


def rows_of(header, *rows):
    """A Markdown table. The columns of numbers are aligned to the right."""
    numeric = [all(re.fullmatch(r"-|[-0-9.,]+%?", row[i]) for row in rows) for i in range(len(header))]
    lines = [header, ["---:" if each else "---" for each in numeric], *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


def prose(text):
    return wrapped(text)


def item_of_list(text):
    return wrapped(f"- {text}", subsequent_indent="  ")


def wrapped(text, **indents):
    """The text as lines. A name with a hyphen is not divided, since a link with a line break leads nowhere."""
    return textwrap.fill(" ".join(text.split()), WIDTH, break_long_words=False, break_on_hyphens=False, **indents)


def episodes(found):
    return sum(count for games in found["episodes"].values() for count in games.values())


def share_of_bench(verified):
    """The speed of the verification beside the bench's; "-" if the bench was not run for all of its games."""
    seconds = verified.get("bench_seconds")
    return number(seconds / verified["seconds"], 2) if seconds else "-"


def best(found, kind):
    """{game: (score, agent)} of the best of the 18 agents of a kind, for games in which all of them have played."""
    scores = {}
    for agent, each in found["scores"].items():
        if agent.startswith(kind + "_"):
            for game, score in each.items():
                scores.setdefault(game, []).append((score, agent))
    all_of_them = max(map(len, scores.values()), default=1)
    return {
        game: max(scores[game], key=lambda pair: pair[0])
        for game in found["games"]
        if len(scores.get(game, ())) == all_of_them
    }


class Part:
    """Writes the parts of a document, in order. A subclass has a method for each section."""

    def __init__(self, folder):
        self.figures = {
            name: json.loads((folder / f"{name}.json").read_text())
            for name in (*PLANS, *AGAIN, *SAMPLES)
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
        if name in SAMPLES:
            return f"`{SAMPLES[name]}`, a sample"
        return AGAIN.get(name, f"`{name}`")
