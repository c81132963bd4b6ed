"""The names that other programs give to games."""

import difflib
import pathlib

from ..errors import BadInput
from ..games import CATALOGUE


def _plain(name: str) -> str:
    return "".join(letter for letter in name.lower() if letter.isalnum())


_OURS = {_plain(name): name for name in CATALOGUE}


def our_name(path: pathlib.Path, name: str) -> str:
    """Returns our name of a game: "battle_zone" for "BattleZone" and "battlezone". Raises BadInput if it is unknown."""
    plain = _plain(name)
    if plain not in _OURS:
        close = difflib.get_close_matches(plain, _OURS, n=1)
        hint = f"did you mean {_OURS[close[0]]}?" if close else "expected a game that racebeam games lists"
        raise BadInput(f"{path}: unknown game '{name}'; {hint}")
    return str(_OURS[plain])
