"""How published scores were made, and why ours differ from them or cannot be compared."""

import dataclasses

import pandas as pd

from ..games import DATA
from ..plan import Protocol

EVERY_AGENT = "*"  # in not_comparable.csv and causes.csv


def _table(name: str) -> pd.DataFrame:
    return pd.read_csv(DATA / f"{name}.csv", dtype=str, keep_default_na=False)


def published_protocols() -> dict[str, Protocol]:
    """Returns the published protocol of each agent."""
    names = [field.name for field in dataclasses.fields(Protocol)]
    rows = _table("protocols").set_index("agent")[names]
    return {str(agent): Protocol(*row) for agent, row in zip(rows.index, rows.itertuples(index=False))}


def sources() -> dict[str, str]:
    """Who published the scores of each agent."""
    return dict(_table("protocols").set_index("agent")["source"])


def not_comparable(agent: str, game: str) -> str | None:
    """Why the published score of an agent in a game cannot be compared with one of today; None if it can."""
    return _found("not_comparable", agent, game)


def cause(agent: str, game: str) -> str | None:
    """Why the score of an agent in a game differs from the published one; None if nobody knows."""
    return _found("causes", agent, game)


def _found(table: str, agent: str, game: str) -> str | None:
    """The last column of the row of the agent and the game."""
    rows = _table(table)
    found = rows[(rows["game"] == game) & rows["agent"].isin([agent, EVERY_AGENT])]
    return str(found.iloc[0, -1]) if len(found) else None
