"""The games: racebeam's names, the paper's two sets and order, the 26 games of Atari 100k, and scores of human
players."""

import difflib
import pathlib

import pandas as pd

from .errors import BadInput

DATA = pathlib.Path(__file__).parent / "data"

# Kaiser et al.: "Model-Based Reinforcement Learning for Atari", arXiv:1903.00374, table of results.
ATARI100K = (
    "alien",
    "amidar",
    "assault",
    "asterix",
    "bank_heist",
    "battle_zone",
    "boxing",
    "breakout",
    "chopper_command",
    "crazy_climber",
    "demon_attack",
    "freeway",
    "frostbite",
    "gopher",
    "hero",
    "jamesbond",
    "kangaroo",
    "krull",
    "kung_fu_master",
    "ms_pacman",
    "pong",
    "private_eye",
    "qbert",
    "road_runner",
    "seaquest",
    "up_n_down",
)

_OTHER = "other"  # the set of a game that the paper does not have


def published(name: str) -> pd.DataFrame:
    """A file of published figures, data/NAME.csv, indexed by its first column."""
    return pd.read_csv(DATA / f"{name}.csv", index_col=0)


PAPER = published("paper2013/games")  # the paper's 55 games in its order: set, title
HUMAN = published("human")  # random, human: published mean scores of 57 games
ATARI57 = tuple(published("atari57").index)  # those with published scores of people, as `games = "atari57"` of a plan
CATALOGUE = tuple(published("catalogue").index)  # the names of all games that racebeam has


def check_games(path: pathlib.Path, games: pd.Series, others: set[str]) -> None:
    """Raises BadInput if one of the games of a file's rows is neither racebeam's nor one of `others`."""
    names = {*CATALOGUE, *others}
    for row, game in enumerate(games.astype("str")):
        if game not in names:
            close = difflib.get_close_matches(game.lower(), names, n=1)
            raise BadInput(
                f"{path}, line {row + 2}: unknown game '{game}'; "
                + (
                    f"did you mean {close[0]}?"
                    if close
                    else "expected a name that racebeam games lists, or that the folder's plan.toml has under [images]"
                )
            )


def in_order(games: list[str]) -> list[str]:
    """The games in the paper's order, then those that it does not have by name."""
    ours = set(games)
    return [game for game in PAPER.index if game in ours] + sorted(ours - set(PAPER.index))


def sets(games: list[str]) -> dict[str, list[str]]:
    """The games of each set, and of all together where there are games of several. The key names the sets."""
    kind = {game: PAPER["set"].get(game, _OTHER) for game in games}
    each = {name: [game for game in games if kind[game] == name] for name in ("training", "testing", _OTHER)}
    found = {name: those for name, those in each.items() if those}
    if len(found) > 1:
        found[" + ".join(found)] = list(games)
    return found
