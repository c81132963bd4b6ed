"""The table of rooms, docs/rooms.toml, and the includes of the C++ sources."""

import pathlib
import re

import tomllib
from tree import ROOT

TABLE = "docs/rooms.toml"
TOP = "top"  # stands for the files of a folder that are in no room
SOURCES = (".cpp", ".hpp", ".inc")
INCLUDE = re.compile(r'^\s*#\s*include "([^"]+)"', re.MULTILINE)
LIBRARY = re.compile(r"^\s*#\s*include <([^>]+)>", re.MULTILINE)
WAIT = re.compile(r"\.wait\((?:false|true|\d)")  # for another value than this one


def read(root=ROOT):
    """The folders with what each may use, and the same for the rooms of each folder."""
    table = tomllib.loads((root / TABLE).read_text())
    return table["folders"], table["rooms"]


def room_of(path):
    """The room of a file, relative to its folder."""
    return pathlib.PurePath(*path.parts[1:-1]).as_posix() if len(path.parts) > 2 else TOP


def includes(root, folders):
    """Pairs of paths: a file, and a file of these folders that it includes."""
    for folder in folders:
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in SOURCES:
                for name in INCLUDE.findall(path.read_text()):
                    if (root / name).is_file() and name.split("/")[0] in folders:
                        yield path.relative_to(root), pathlib.PurePath(name)


def uses_of(path, header, rooms):
    """The row of the table that an include needs, as (its list, its key, the entries that allow it). None if both files
    are in one room."""
    folder, other = path.parts[0], header.parts[0]
    if folder != other:
        return "folders", folder, {other}
    room, target = room_of(path), room_of(header)
    if room == target or folder not in rooms:
        return None
    return folder, room, {target, header.relative_to(folder).as_posix()}


def faults(root=ROOT):
    """A line for each include that the table does not allow, and for each row that allows what nobody includes."""
    folders, rooms = read(root)
    lists = {"folders": folders} | rooms
    idle = {(name, key, entry) for name, rows in lists.items() for key, row in rows.items() for entry in row}
    wrong = []
    for path, header in includes(root, folders):
        row = uses_of(path, header, rooms)
        if row is None:
            continue
        name, key, entries = row
        allowed = entries & set(lists[name].get(key, ()))
        if not allowed:
            wrong.append(f"{path} includes {header}")
        idle -= {(name, key, entry) for entry in allowed}
    return wrong + [f"{TABLE}: nothing in {key} of {name} uses {entry}" for name, key, entry in sorted(idle)]


def order_faults(root=ROOT):
    """A line for each row that names a row at or below its own: the table could then have a circle."""
    folders, rooms = read(root)
    wrong = []
    for name, rows in ({"folders": folders} | rooms).items():
        above = set()
        for key, row in rows.items():
            wrong += [
                f"{name}: {key} uses {entry}" for entry in row if not entry.endswith(".hpp") and entry not in above
            ]
            above.add(key)
    return wrong


def missing(root=ROOT):
    """Folders of the table that have rooms with sources which the table lacks, as paths."""
    _, rooms = read(root)
    found = set()
    for folder, rows in rooms.items():
        sources = [path.relative_to(root) for path in (root / folder).rglob("*.[hc]pp")]
        found |= {path.parent.as_posix() for path in sources if room_of(path) not in rows}
    return sorted(found)


def portable_sources(root, table):
    """The sources that may not include headers of an operating system."""
    exempt = {root / folder for folder in table["except"]}
    for folder in table["folders"]:
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in SOURCES and not exempt.intersection((path, *path.parents)):
                yield path


def waits_for_atomics(root=ROOT):
    """The portable sources that wait for the value of an atomic variable."""
    table = tomllib.loads((root / TABLE).read_text())["portable"]
    paths = [path for path in portable_sources(root, table) if WAIT.search(path.read_text())]
    return [path.relative_to(root).as_posix() for path in paths]


def system_faults(root=ROOT):
    """A line for each include of a portable source that is neither of the C++ library, whose names have no mark, nor in
    the table, or that the table refuses; and for each header of the table that nobody includes."""
    table = tomllib.loads((root / TABLE).read_text())["portable"]
    idle = set(table["headers"])
    wrong = []
    for path in portable_sources(root, table):
        for name in LIBRARY.findall(path.read_text()):
            if name in table["refused"]:
                wrong.append(f"{path.relative_to(root)} includes {name}")
            if not re.search(r"\W", name):
                continue
            library = name.split("/")[0]
            if library not in table["headers"]:
                wrong.append(f"{path.relative_to(root)} includes {name}")
            idle.discard(library)
    return wrong + [f"{TABLE}: no portable source includes {name}" for name in sorted(idle)]
