"""A request that takes long, for tests of what happens meanwhile."""

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
from harness import (
    LOAD,
    thread_sanitized,
)

FRAMES = 100 if thread_sanitized() else 1000


LONG = b"branch root " + b"NOOP*%d " % FRAMES * 100 + b"\n"  # 100,000 frames, or fewer where they take longer: a second


def load(wire, request=b""):
    """Loads a game, sends the request directly after it, and waits until only its reply is missing."""
    wire.send(LOAD + request)
    for _ in LOAD.splitlines():
        wire.line()
