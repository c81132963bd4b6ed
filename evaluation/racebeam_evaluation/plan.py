"""What the plans of several folders of results say differently."""

import pathlib

_OWN = {"name", "seed", "games", "agents", "trials"}  # keys in which the plans of one report may differ
_OWN_TABLES = {"images"}                              # images are compared in results.csv

Settings = dict[str, str]  # by KEY or TABLE.KEY, as the plan has it


def differences(folders: list[pathlib.Path]) -> tuple[str, ...]:
    """A sentence for each setting that two plans have with different values. A folder without plan.toml is left out.

    A key that only one plan has is no difference: the other has no such agent."""
    seen: dict[str, tuple[str, str]] = {}
    sentences: dict[str, str] = {}
    for folder in folders:
        path = folder / "plan.toml"
        for key, value in (_settings(path) if path.exists() else {}).items():
            first, other = seen.setdefault(key, (value, folder.name))
            if first != value:
                sentences.setdefault(key, f"The plans differ: {key} is {first} in {other}, and {value} in {folder.name}; "
                                          "scores are of both.")
    return tuple(sentences.values())


def _settings(path: pathlib.Path) -> Settings:
    """Of a plan as racebeam writes it: a table's head, or a key and its value, on each line."""
    settings, table = {}, ""
    for line in path.read_text(errors="replace").splitlines():
        if line.startswith("[") and line.endswith("]"):
            table = line[1:-1]
            continue
        key, equals, value = line.partition(" = ")
        if equals and key not in _OWN and table not in _OWN_TABLES:
            settings[f"{table}.{key}" if table else key] = value
    return settings
