"""Sentences below tables: what is not in them, and why."""

from .bootstrap import FEWEST_TRIALS
from .normalise import Ranges
from .paired import Pair
from .results import Results
from .scores import Group, Scores


def counted_games(count: int) -> str:
    return "1 game" if count == 1 else f"{count} games"


def _list(names: list[str]) -> str:
    return ", ".join(names)


def of_aggregates(scores: Scores, group: Group, ranges: list[Ranges]) -> tuple[str, ...]:
    """Games that one agent lacks, games without a score range, and what is special of the ranges and trials."""
    common = scores.common(group)
    lacking = [game for game in scores.columns(group.agents).dropna(how="all").index if game not in common]
    sentences = [f"Not every agent has played {_list(lacking)}: not aggregated."] if lacking else []
    for each in ranges:
        without = each.without(common)
        if without:
            sentences.append(f"No {each.name} score (n/a) in {_list(without)}: the range is unknown or empty.")
        sentences += each.notes
    return (*sentences, *of_trials(scores, group))


def of_left_out(scores: Scores, results: Results) -> list[str]:
    """The tables that the report does not have."""
    groups = [group.name for group in scores.groups]
    lacking = [
        f"The results lack {role}: the tables {group}-... are left out."
        for role, group in (("learners", "learning"), ("planners", "planning"))
        if group not in groups
    ]
    if groups == ["baselines"]:
        lacking.append("There are only baselines: the tables groups, -tests, -means and -improvement are left out.")
    if results.curves is None:
        lacking.append("The results lack training episodes: the learning curves are left out.")
    return lacking


def of_trials(scores: Scores, group: Group) -> tuple[str, ...]:
    """Agents whose numbers of trials are too small for an interval, or differ between games."""
    sentences = []
    for agent in group.agents if scores.trials is not None else ():
        counts = [len(scores.trial_scores(agent, game)) for game in scores.columns((agent,)).dropna().index]
        if counts and min(counts) < FEWEST_TRIALS:
            sentences.append(f"{agent} has a game with {min(counts)} trial: no interval (n/a).")
        elif counts and min(counts) < max(counts):
            sentences.append(f"{agent} has {min(counts)} to {max(counts)} trials: each game counts the same.")
    return tuple(sentences)


def of_lacking(found: list[Pair]) -> tuple[str, ...]:
    """Games that one of two agents lacks."""
    return tuple(
        f"{pair.first} and {pair.second} are compared in {counted_games(len(pair.games))}; only one of them has played "
        f"{_list(pair.lacking)}."
        for pair in found
        if pair.lacking
    )


def of_untested(scores: Scores, group: Group, found: list[Pair]) -> list[str]:
    """Tests that could not be made: a sentence for each agent with too few trials, and for each pair without
    variance."""
    few: dict[str, list[str]] = {}
    for pair in found:
        for agent in (pair.first, pair.second):
            short = [game for game in pair.few if len(scores.trial_scores(agent, game)) < FEWEST_TRIALS]
            few[agent] = [*few.get(agent, []), *(game for game in short if game not in few.get(agent, []))]
    sentences = [
        f"Not tested: {agent} on {_list(games)} has fewer than {FEWEST_TRIALS} trials; "
        f"a test takes {FEWEST_TRIALS} or more."
        for agent, games in few.items()
        if games
    ]
    return sentences + [
        f"Not tested: {pair.first} and {pair.second} on {_list(pair.constant)} have no variance; "
        f"a test takes trials that differ."
        for pair in found
        if pair.constant
    ]
