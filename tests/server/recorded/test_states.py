"""The program imports states that earlier versions exported. VERSION.states.json has them.

They must continue as they did, if the number of their form is still that of the program. Otherwise the program must
refuse them by that number. The file has, for each of our own games, the state (deflated, in base64). For each request
after it, the file has the state hash and the Adler-32 of the screen.
"""

import base64
import json
import pathlib
import re
import struct
import zlib

import pytest
from test_recorded import hold

FILES = sorted(pathlib.Path(__file__).resolve().parent.glob("*.states.json"))
STATES = [(path.name, game, record) for path in FILES for game, record in json.loads(path.read_text()).items()]
FORM_AT = 8  # docs/states.md, the table of bytes


def form(state):
    return struct.unpack_from("<I", state, FORM_AT)[0]


def value(reply, key):
    return re.search(rf" {key}=(\S+)", reply)[1]


def seen(reply):
    """Returns the part of a reply that the file records: the hash of the state, and a checksum of the screen."""
    return f"{value(reply, 'state_hash')} {zlib.adler32(bytes.fromhex(value(reply, 'screen'))):08x}"


def test_there_are_states():
    assert STATES


@pytest.mark.parametrize(("file", "game", "record"), STATES, ids=[f"{file}-{game}" for file, game, _ in STATES])
def test_an_exported_state_continues_or_is_refused_by_its_number(file, game, record):
    state = zlib.decompress(base64.b64decode("".join(record["state"])))
    requests, expected = zip(*(re.fullmatch(r"(.+) (\w+ \w+)", frame).groups() for frame in record["frames"]))
    load, _, _, own, imported, _, *frames = hold(
        [
            f"load {game} seed=99 frame_skip=4",
            "observe state_hash screen:hex",
            "save own",
            "export own",
            f"import state {base64.b64encode(state).decode()}",
            "restore state",
            *requests,
        ]
    )
    assert load.startswith("ok ")
    if form(state) != form(base64.b64decode(value(own, "data"))):
        assert re.match(rf"error bad-state .*\bformat {form(state)}\b", imported)
        return
    assert imported.startswith("ok ")
    assert [seen(frame) for frame in frames] == list(expected)
