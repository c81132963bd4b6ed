"""The table of attacks, and what they have in common.

An attack is a generator. It yields the result of each check: an empty text if the program withstood it, else a sentence
that names the fault. scripts/check/attacks runs the attacks, and counts checks and faults.
"""

import contextlib
import os
import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "server"))
from harness import BINARY, PATIENCE, Session  # noqa: E402

ATTACKS = {}  # by name: the function, and how often it is made by default
LOAD = b"load beamfall seed=1 sticky=0 max_episode_frames=0"
UNSOUND = re.compile(r"Sanitizer|terminate called|Assertion|Segmentation|basic_string|std::")


class Lacking(Exception):
    """This machine lacks what an attack needs."""


def attack(times):
    """Registers a function of a random.Random and a number of times."""

    def register(function):
        ATTACKS[function.__name__.replace("_", "-")] = (function, times)
        return function

    return register


def fault_of_line(line):
    """Returns a fault unless a reply is one line of printable ASCII that begins with ok or error."""
    if not re.fullmatch(rb"(ok|error [a-z-]+)( [ -~]*)?\n", line):
        return f"the reply is {line[:200]!r}"
    return ""


def fault_of_end(status, errors, accepted=(0, 1, 2)):
    """Returns a fault unless a process ended with an accepted status, and wrote only sentences to standard error."""
    if status not in accepted:
        return f"the status is {status}: {errors[-300:]!r}"
    if UNSOUND.search(errors) or not all(line.isprintable() for line in errors.splitlines()):
        return f"it writes {errors[-300:]!r}"
    return ""


class Talk:
    """A session of the line protocol with a new server, over standard streams."""

    def __init__(self, *options):
        self.session = Session("stdio", *options, image=None)
        self.received = b""

    def __enter__(self):
        self.session.__enter__()
        return self

    def __exit__(self, *_):
        self.session.__exit__()

    def send(self, data):
        self.session.wire.send(data)

    def line(self):
        """Returns the next line, with its end."""
        while b"\n" not in self.received:
            part = self.session.wire.read(1 << 18)
            if not part:
                raise AssertionError(f"the server closed its end after {self.received[-100:]!r}")
            self.received += part
        line, _, self.received = self.received.partition(b"\n")
        return line + b"\n"

    def ask(self, request):
        self.send(request + b"\n")
        return self.line()


def resident(session):
    """The memory of a session's server, in MiB."""
    status = pathlib.Path(f"/proc/{session.server.process.pid}/status").read_text()
    return int(re.search(r"VmRSS:\s+(\d+)", status)[1]) / 1024


def run(*words, data=b"", cwd=None, timeout=PATIENCE, **environment):
    """Returns the status, the output, and the text on standard error."""
    done = subprocess.run(
        [BINARY, *map(str, words)],
        input=data,
        capture_output=True,
        timeout=timeout,
        cwd=cwd,
        env=os.environ | environment,
    )
    return done.returncode, done.stdout, done.stderr.decode(errors="replace")


def files_in(folder):
    """The contents of all files below a folder, by their paths."""
    return {
        path.relative_to(folder).as_posix(): path.read_bytes()
        for path in sorted(pathlib.Path(folder).rglob("*"))
        if path.is_file() and not path.is_symlink()
    }


@contextlib.contextmanager
def small_disk(pages):
    """A folder on a new file system that has room for `pages` pages of 4 KiB."""
    if os.geteuid() != 0:
        raise Lacking("only root can mount a small disk")
    with tempfile.TemporaryDirectory() as folder:
        mount = ["mount", "-t", "tmpfs", "-o", f"size={pages * 4}k", "attack", folder]
        if subprocess.run(mount, capture_output=True).returncode != 0:
            raise Lacking("a small disk cannot be mounted here")
        try:
            yield pathlib.Path(folder)
        finally:
            subprocess.run(["umount", "-l", folder], check=True)
