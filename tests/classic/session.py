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
    said = "".join(line + "\n" for line in run.said()).encode()
    done = subprocess.run([*command, *run.options(), image], input=said, capture_output=True, timeout=PATIENCE)
    return Answer(done.returncode, done.stdout, done.stderr.decode(errors="replace").strip())


def difference(run, expected, found):
    """A sentence on where `found` first differs from `expected`; None if it does not."""
    if expected.output == found.output and expected.status == found.status:
        return None
    for number, (wanted, had) in enumerate(zip(expected.lines, found.lines)):
        if wanted != had:
            return f"line {number}, {after(run, number)}: {fields(wanted, had)}"
    if len(expected.lines) != len(found.lines):
        return f"{len(found.lines)} lines, not {len(expected.lines)}"
    return f"status {found.status}, not {expected.status}"


def after(run, number):
    """The client's line before the server's line of that number; 0 is the size of the screen."""
    said = ["nothing", *run.said()]
    return f"after '{said[number]}'" if number < len(said) else "at the end"


def fields(wanted, had):
    wanted, had = wanted.split(b":"), had.split(b":")
    if len(wanted) != 4 or len(had) != 4:
        return f"{had[-1][:20]!r}, not {wanted[-1][:20]!r}"
    told = []
    if wanted[0] != had[0]:
        told.append("RAM " + bytes_that_differ(wanted[0].decode(), had[0].decode()))
    if wanted[1] != had[1]:
        told.append("screen")
    if wanted[2] != had[2]:
        told.append(f"episode {had[2].decode()}, not {wanted[2].decode()}")
    return "; ".join(told)


def bytes_that_differ(wanted, had):
    differing = [at for at in range(0, min(len(wanted), len(had)), 2) if wanted[at : at + 2] != had[at : at + 2]]
    shown = [f"{0x80 + at // 2:02X}={had[at : at + 2]} not {wanted[at : at + 2]}" for at in differing[:SHOWN]]
    more = len(differing) - len(shown)
    return " ".join(shown) + (f" and {more} bytes more" if more else "")
