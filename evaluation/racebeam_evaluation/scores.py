"""Scores of agents in games: means of trials, views of the baselines, and groups of agents that are compared."""

import dataclasses
import re

import numpy as np
import numpy.typing as npt
import pandas as pd

from .errors import BadInput
from .games import in_order
from .results import DIVERGED, Results

BASELINES = 37  # Random, and one Const and one Perturb policy for each of 18 actions
BASELINE_VIEWS = ("random", "const", "perturb")  # const and perturb: the best of 18 in each game
_BASELINE = re.compile("random|(const|perturb)[-_].+")  # such as const_noop
# In the order of tables. Other agents follow those of their role, which agents.csv says; without it, they are learners.
_LEARNERS = ("basic", "bass", "disco", "lsh", "ram", "blob_prost")
_PLANNERS = ("full_tree", "uct", "iw1", "rollout_iw1")


Trials = dict[tuple[str, str], npt.NDArray[np.float64]]  # by agent and game


@dataclasses.dataclass(frozen=True)
class Group:
    """Agents that are compared with each other."""

    name: str
    agents: tuple[str, ...]


@dataclasses.dataclass(frozen=True)
class Scores:
    """Scores of every agent in every game."""

    means: pd.DataFrame  # of trials: a row for each game, a column for each agent; NaN: not played
    trials: Trials | None  # the mean of each trial of an agent in a game; None: only `means` are known
    references: pd.DataFrame  # scores of baselines: a row for each game, a column for each baseline
    views: pd.DataFrame  # scores of BASELINE_VIEWS: a row for each game
    notes: tuple[str, ...] = ()  # sentences on what was left out
    other_rewards: tuple[str, ...] = ()  # games whose rewards were others than those of today
    planners: tuple[str, ...] = _PLANNERS
    samples: Trials = dataclasses.field(default_factory=dict)  # independent scores: see `sample`

    @property
    def groups(self) -> list[Group]:
        """Learners and planners, each if there are some. Without both, the baselines."""
        planners = tuple(agent for agent in self.means if agent in self.planners)
        learners = tuple(agent for agent in self.means if agent not in self.planners)
        groups = [Group("learning", learners), Group("planning", planners)]
        return [group for group in groups if group.agents] or [Group("baselines", tuple(self.views))]

    def columns(self, agents: tuple[str, ...]) -> pd.DataFrame:
        """The scores of agents or views."""
        return pd.concat([self.means, self.views], axis=1)[list(agents)]

    def common(self, group: Group) -> list[str]:
        """The games that all agents of the group have played."""
        return list(self.columns(group.agents).dropna().index)

    def trial_scores(self, agent: str, game: str) -> npt.NDArray[np.float64]:
        """The means of the agent's trials of the game; empty if they are missing or unknown."""
        return (self.trials or {}).get((agent, game), np.empty(0))

    def sample(self, agent: str, game: str) -> npt.NDArray[np.float64]:
        """Independent scores of an agent, or of the policy that is a view's best: the means of trials if they were
        trained, else the episodes."""
        policies = [agent] if agent not in self.views else [name for name in self.references if _view_of(name) == agent]
        found = [self.samples[name, game] for name in policies if (name, game) in self.samples]
        return max(found, key=np.mean, default=np.empty(0))


def scores_of(results: Results) -> Scores:
    """The scores of evaluation episodes. A trial that diverged has no score, and is named in the notes.

    Raises BadInput if all scores are missing."""
    diverged = results.episodes["end"] == DIVERGED
    diverged_trials = results.episodes[diverged][["game", "agent", "trial"]].drop_duplicates()
    episodes = results.episodes[~diverged]
    if not len(episodes):
        raise BadInput("every trial diverged; expected a score of one trial or more")
    trials = episodes.groupby(["game", "agent", "trial"])["score"].mean()
    means = trials.groupby(["game", "agent"]).mean().unstack("agent")
    means = means.reindex(index=in_order(list(set(results.episodes["game"]))))
    roles = {name: results.roles.get(name) or _usual_role(name) for name in means}
    references = means[[name for name in means if roles[name] == "baseline"]]
    lost_trials = [
        f"Trial {row.trial} of {row.agent} on {row.game} diverged, and is in no mean."
        for row in diverged_trials.itertuples()
    ]
    return Scores(
        means=means[_agents_in_order(roles)],
        trials=_by_agent_and_game(trials),
        samples=_by_agent_and_game(trials) | _by_agent_and_game(_untrained(episodes, roles)),
        references=references,
        views=_views(references),
        notes=(*results.notes, *lost_trials),
        planners=tuple(name for name in means if roles[name] == "planner"),
    )


def _by_agent_and_game(trials: pd.Series) -> Trials:
    return {(agent, game): scores.to_numpy() for (game, agent), scores in trials.groupby(["game", "agent"])}


def _untrained(episodes: pd.DataFrame, roles: dict[str, str]) -> pd.Series:
    """The scores of the episodes of agents that do not learn."""
    selection = episodes[episodes["agent"].map(lambda name: roles[name] != "learner")]
    return selection.set_index(["game", "agent"])["score"]


def _usual_role(agent: str) -> str:
    """Returns the role of an agent of racebeam; agents.csv says the role of another."""
    if _BASELINE.fullmatch(agent):
        return "baseline"
    return "planner" if agent in _PLANNERS else "learner"


def _view_of(baseline: str) -> str:
    """The view that the scores of a baseline belong to."""
    found = _BASELINE.fullmatch(baseline)
    return found[1] or baseline if found else baseline


def _agents_in_order(roles: dict[str, str]) -> list[str]:
    """Returns the learners, then the planners, and of each the known ones first."""
    order: list[str] = []
    for role, names in (("learner", _LEARNERS), ("planner", _PLANNERS)):
        agents = sorted(name for name in roles if roles[name] == role)
        order += [name for name in names if name in agents] + [name for name in agents if name not in names]
    return order


def _views(references: pd.DataFrame) -> pd.DataFrame:
    """Random, the best Const and Perturb policy of each game, and other baselines."""
    names = [*BASELINE_VIEWS, *sorted({_view_of(name) for name in references} - set(BASELINE_VIEWS))]
    best = {view: references[[name for name in references if _view_of(name) == view]].max(axis=1) for view in names}
    return pd.DataFrame(best, index=references.index).dropna(axis=1, how="all")
