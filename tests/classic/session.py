"""A run in one server: its output, and where the outputs of two servers differ."""

import os
import subprocess
from dataclasses import dataclass

from images import SOURCE

BINARY = os.environ.get("RACEBEAM_BINARY", str(SOURCE / "build/release/racebeam"))
PATIENCE = 300  # seconds for one session
SHOWN = 8  # bytes of RAM that a report names


@dataclass(frozen=True)
class Answer:
    """All output of a server."""

    status: int
    output: bytes
    errors: str

    @property
    def lines(self):
        return self.output.split(b"\n")[:-1]


def play(command, run, image):
    """The output of the server with this command, without its options. Raises subprocess.TimeoutExpired."""
    requests = "".join(line + "\n" for line in run.requests()).encode()
    done = subprocess.run([*command, *run.options(), image], input=requests, capture_output=True, timeout=PATIENCE)
    return Answer(done.returncode, done.stdout, done.stderr.decode(errors="replace").strip())


def difference(run, expected, found):
    """A sentence on where `found` first differs from `expected`; None if it does not."""
    if expected.output == found.output and expected.status == found.status:
        return None
    for number, (line, other) in enumerate(zip(expected.lines, found.lines)):
        if line != other:
            return f"line {number}, {after(run, number)}: {fields(line, other)}"
    if len(expected.lines) != len(found.lines):
        return f"{len(found.lines)} lines, not {len(expected.lines)}"
    return f"status {found.status}, not {expected.status}"


def after(run, number):
    """The client's line before the server's line of that number; 0 is the size of the screen."""
    requests = ["nothing", *run.requests()]
    return f"after '{requests[number]}'" if number < len(requests) else "at the end"


def fields(expected, found):
    expected, found = expected.split(b":"), found.split(b":")
    if len(expected) != 4 or len(found) != 4:
        return f"{found[-1][:20]!r}, not {expected[-1][:20]!r}"
    parts = []
    if expected[0] != found[0]:
        parts.append("RAM " + bytes_that_differ(expected[0].decode(), found[0].decode()))
    if expected[1] != found[1]:
        parts.append("screen")
    if expected[2] != found[2]:
        parts.append(f"episode {found[2].decode()}, not {expected[2].decode()}")
    return "; ".join(parts)


def bytes_that_differ(expected, found):
    differing = [
        at for at in range(0, min(len(expected), len(found)), 2) if expected[at : at + 2] != found[at : at + 2]
    ]
    parts = [f"{0x80 + at // 2:02X}={found[at : at + 2]} not {expected[at : at + 2]}" for at in differing[:SHOWN]]
    more = len(differing) - len(parts)
    return " ".join(parts) + (f" and {more} bytes more" if more else "")
