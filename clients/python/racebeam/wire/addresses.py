"""Addresses of servers, and the files that hold them."""

from __future__ import annotations

import json
import os
import re
import stat
import time
from collections.abc import Callable
from typing import Any, TypeVar

ANNOUNCEMENT = 1  # the version of announce files that this client reads
BETWEEN_TRIES = 0.05  # seconds
WAIT = re.compile(r"(file:.+)\?wait=(.*)", re.DOTALL)
SECONDS = re.compile(r"[0-9]{1,9}(\.[0-9]+)?")
ADDRESSES = (
    "it takes tcp://HOST:PORT, tls://HOST:PORT, unix:PATH, pipes:PREFIX, stdio or file:PATH, also in RACEBEAM_ADDRESS"
)
ON_WINDOWS = "on Windows, it takes tcp://HOST:PORT, tls://HOST:PORT, stdio or file:PATH"
IS_WINDOWS = os.name == "nt"
FILES = "file:PATH takes the --ready-file or --announce file of a server"

Opened = TypeVar("Opened")


def reach(address: str | None, open_address: Callable[[str], Opened]) -> tuple[Opened, str, str | None]:
    """Opens a connection. Tries again for as long as ?wait= of the address says.

    Args:
        address: Address of the server, or None for that of RACEBEAM_ADDRESS.
        open_address: Opens a connection to an address that is not a file.

    Returns:
        The connection, its address, and the token of the announce file or None.

    Raises:
        ValueError: If the address is invalid, or the file has no address.
        OSError: If no server answers.
    """
    address = address or os.environ.get("RACEBEAM_ADDRESS", "")
    if not address:
        raise ValueError(f"the address is missing, and the variable RACEBEAM_ADDRESS is not set; {ADDRESSES}")
    wait = WAIT.fullmatch(address)
    if wait and not SECONDS.fullmatch(wait[2]):
        raise ValueError(f"the address is {address!r}; ?wait= takes seconds, from 0 to 999999999")
    file = wait[1] if wait else address
    until = time.monotonic() + (float(wait[2]) if wait else 0)
    while True:
        found = file
        try:
            found, token = _read_file(file)
            if IS_WINDOWS and found.startswith(("unix:", "pipes:")):
                raise ValueError(f"the address is {found!r}; {ON_WINDOWS}")
            return open_address(found), found, token
        except OSError as error:
            if time.monotonic() >= until:
                source = "" if found == file else f", which {file.removeprefix('file:')} names"
                sentence = f"no server answers at {found}{source}: {error.strerror or error}"
                if not error.strerror:  # such as a TimeoutError
                    raise type(error)(sentence) from error
                error.strerror, error.args = sentence, (error.errno, sentence)  # the latter are what pickle copies
                raise
            time.sleep(BETWEEN_TRIES)


def _read_file(address: str) -> tuple[str, str | None]:
    """Returns the first usable address of a ready file or an announce file, and its token.

    Other addresses are returned as they are.
    """
    if not address.startswith("file:"):
        return address, None
    path = address.removeprefix("file:")
    if not stat.S_ISREG(os.stat(path).st_mode):  # a pipe might block
        raise ValueError(f"{path} is not a regular file; {FILES}")
    with open(path, encoding="utf-8", errors="surrogateescape") as file:
        text = file.read()
    addresses, token = _parse_announcement(path, text) if text.startswith("{") else (text.splitlines(), None)
    for line in addresses:
        if line.startswith(("tcp://", "tls://", "unix:", "pipes:")):
            return line, token
    if text.startswith(("{", "#")):
        raise ValueError(f"{path} names no address that this client can use")
    raise ValueError(f"{path} {'has other contents' if text else 'is empty'}; {FILES}")


def _parse_announcement(path: str, text: str) -> tuple[list[str], str | None]:
    """Returns the addresses and the token of an announce file."""
    try:
        announcement: dict[str, Any] = json.loads(text)
        version = announcement["racebeam_announce"]
        if version == ANNOUNCEMENT:
            return announcement["addresses"], announcement["token"]
    except (KeyError, TypeError, ValueError, RecursionError):
        raise ValueError(f"{path} is not a whole announce file") from None
    raise ValueError(f"{path} is an announce file of version {version}; this client reads version {ANNOUNCEMENT}")
