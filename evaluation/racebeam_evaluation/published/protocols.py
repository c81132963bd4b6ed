"""How published scores were made, and what keeps ours from being compared with them."""

import dataclasses

import pandas as pd

from ..games import DATA
from ..plan import Protocol

EVERY_AGENT = "*"  # in not_comparable.csv


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


def cause(agent: str, game: str) -> str | None:
    """Why the published score of an agent in a game cannot be compared with one of today; None if it can."""
    rows = _table("not_comparable")
    found = rows[(rows["game"] == game) & rows["agent"].isin([agent, EVERY_AGENT])]
    return str(found["reason"].iloc[0]) if len(found) else None
