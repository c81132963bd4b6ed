"""Reads CSV files strictly: each column that is needed is there, and each number is a number."""

import csv
import dataclasses
import enum
import hashlib
import io
import os
import pathlib
import stat

import numpy as np
import pandas as pd

from .errors import BadInput


class Kind(enum.Enum):
    """What the cells of a column hold. The value completes the sentence "expected ..."."""

    TEXT = "text"
    NAME = "a name"
    WHOLE = "a whole number from 0 to 2147483647"
    DECIMAL = "a decimal number from -1e15 to 1e15"
    OPTIONAL = "a decimal number from -1e15 to 1e15, or nothing"


_TEXTS = (Kind.TEXT, Kind.NAME)
MOST_WHOLE = 2**31 - 1
MOST_DECIMAL = 1e15  # sums of squares are finite
_MOST_BYTES = 2**29


@dataclasses.dataclass(frozen=True)
class Source:
    """A file that tables are made from."""

    name: str  # the file's name without its folder
    sha256: str  # the digest of its bytes, in hexadecimal


def read(
    path: pathlib.Path, columns: dict[str, Kind], may_be_empty: bool = False, optional: dict[str, Kind] | None = None
) -> tuple[pd.DataFrame, Source]:
    """Returns the columns of the file at `path` that `columns` names, those of `optional` that it has, and the digest
    of the file. It has rows, unless it may be empty.

    Cells of the kinds TEXT and NAME become categories, WHOLE int64, the others float64; nothing is NaN. The row of
    index i is on line i + 2. Other columns are ignored. Raises BadInput, which names the file, and the line where there
    is one."""
    content = content_of(path, _MOST_BYTES, "a CSV file")
    _check_shape(path, content, columns, 0 if may_be_empty else 1)
    header = content.splitlines()[0].decode().split(",")
    columns = columns | {name: kind for name, kind in (optional or {}).items() if name in header}
    types = {name: "category" if kind in _TEXTS else "str" for name, kind in columns.items()}
    frame = pd.read_csv(
        io.BytesIO(content), usecols=list(columns), dtype=types, keep_default_na=False, quoting=csv.QUOTE_NONE
    )
    for name, kind in columns.items():
        if kind is Kind.NAME:
            _refuse(path, frame[name], frame[name].str.strip() == "", kind)
        if kind not in _TEXTS:
            frame[name] = _numbers(path, frame[name], kind)
    return frame, Source(path.name, hashlib.sha256(content).hexdigest())


def content_of(path: pathlib.Path, most: int, kind: str) -> bytes:
    """The bytes of the file at `path`. Raises BadInput for a file of more than `most` bytes before it is read, and for
    a pipe or a device, whose end may never come."""
    try:
        found = path.stat()
        if not stat.S_ISREG(found.st_mode) and not stat.S_ISDIR(found.st_mode):
            raise BadInput(f"{path} is a pipe, a socket or a device; expected {kind}")
        if found.st_size > most:
            raise BadInput(f"{path} has {found.st_size} bytes; expected {kind} of at most {most}")
        with open(path, "rb", opener=_open_without_waiting) as file:
            content = file.read(most + 1) or b""  # a file that grows, or that has no size; None: a pipe took its place
    except OSError as error:
        raise BadInput(f"{path} cannot be read: {error.strerror}; expected {kind}") from error
    if len(content) > most:
        raise BadInput(f"{path} has more than {most} bytes; expected {kind} of at most {most}")
    return content


def _open_without_waiting(path: str, flags: int) -> int:
    return os.open(path, flags | getattr(os, "O_NONBLOCK", 0))


def digest(path: pathlib.Path) -> Source:
    """The source that the file at `path` is."""
    return Source(path.name, hashlib.sha256(path.read_bytes()).hexdigest())


def _check_shape(path: pathlib.Path, content: bytes, columns: dict[str, Kind], fewest: int) -> None:
    """Checks that the header has `columns`, each line as many fields, and the file at least `fewest` rows."""
    try:
        content.decode()
    except UnicodeDecodeError as error:
        raise BadInput(f"{path}: byte {error.start} is not UTF-8; expected a CSV file in UTF-8") from error
    lines = content.splitlines()
    header = lines[0].decode().split(",") if lines else []
    lacking = [name for name in columns if name not in header]
    if lacking:
        what = "column" if len(lacking) == 1 else "columns"
        raise BadInput(f"{path} lacks the {what} {', '.join(lacking)}; expected at least {','.join(columns)}")
    for number, line in enumerate(lines, 1):
        fields = line.count(b",") + 1
        if fields != len(header):
            raise BadInput(f"{path}, line {number}, has {fields} fields; expected {len(header)}, as the header has")
    if len(lines) - 1 < fewest:
        raise BadInput(f"{path} has no rows; expected at least one below the header")


def _numbers(path: pathlib.Path, cells: pd.Series, kind: Kind) -> pd.Series:
    """The cells of a column as numbers of `kind`."""
    values = pd.to_numeric(cells, errors="coerce").astype(float)
    wrong = ~np.isfinite(values)
    if kind is Kind.OPTIONAL:
        wrong &= cells != ""
    if kind is Kind.WHOLE:
        wrong |= (values < 0) | (values > MOST_WHOLE) | (values % 1 != 0)
    else:
        wrong |= values.abs() > MOST_DECIMAL
    _refuse(path, cells, wrong, kind)
    return values.astype(np.int64) if kind is Kind.WHOLE else values


def _refuse(path: pathlib.Path, cells: pd.Series, wrong: pd.Series, kind: Kind) -> None:
    """Raises BadInput for the first cell that is wrong, if one is."""
    if wrong.any():
        row = int(np.flatnonzero(wrong)[0])
        raise BadInput(f"{path}, line {row + 2}: {cells.name} is '{cells[row]}'; expected {kind.value}")
