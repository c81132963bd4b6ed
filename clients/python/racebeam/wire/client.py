"""A client of the racebeam line protocol (protocol/PROTOCOL.md), which needs the standard library only.

    with launch() as game:  # or connect("tcp://HOST:PORT"), or another address
        game.load("beamfall", seed=7, frame_skip=4)
        game.observe("reward", "terminated", "truncated", "ram", "screen:delta")
        while True:
            reply = game.act("FIRE")  # {"reward": 0, "terminated": 0, ..., "screen": bytes}
            if reply["terminated"] or reply["truncated"]:
                break

A session has a method for each command, in the order of the document. It returns numbers as int or float, and bytes as
bytes; or as arrays of NumPy, if it was opened with arrays=True. If the server refuses a request, the method raises
Refused, and the session continues. It raises ConnectionError if the server is gone, and TimeoutError if the server does
not answer in time. Both end the session.
"""

from __future__ import annotations

from .addresses import ANNOUNCEMENT
from .connection import LONGEST_REPLY
from .encodings import DECODERS, apply_delta, decode_rewards, decode_runs
from .fields import SHAPES, USUAL_ENCODING
from .messages import PROTOCOL, Refused, Reply, Texts, Values
from .opening import connect, launch
from .session import Session
from .stack import Stack

__all__ = [
    "ANNOUNCEMENT",
    "DECODERS",
    "LONGEST_REPLY",
    "PROTOCOL",
    "SHAPES",
    "USUAL_ENCODING",
    "Refused",
    "Reply",
    "Session",
    "Stack",
    "Texts",
    "Values",
    "apply_delta",
    "connect",
    "decode_rewards",
    "decode_runs",
    "launch",
]
