"""States that one process exports are continued by another: golden --save-states, --play-states."""

import os
import pathlib
import re
import subprocess

import pytest

GOLDEN = os.environ.get(
    "RACEBEAM_GOLDEN", pathlib.Path(__file__).resolve().parents[2] / "build/release/tests/golden/golden"
)


def golden(*options):
    """Runs the program. Returns its status, its output, and its errors."""
    done = subprocess.run([GOLDEN, *map(str, options)], capture_output=True, text=True)
    return done.returncode, done.stdout.strip(), done.stderr.strip()


class TestStates:
    @pytest.fixture(scope="class", autouse=True)
    @classmethod
    def set_up_class(cls, tmp_path_factory):
        folder = tmp_path_factory.mktemp("states")
        cls.states = pathlib.Path(folder, "states")
        cls.saved = golden("--save-states", cls.states)

    def test_another_process_continues_them_with_the_same_digest(self):
        status, digest, errors = self.saved
        assert (status, errors) == (0, "")
        assert re.search("^[0-9a-f]{32}$", digest)
        assert golden("--play-states", self.states) == self.saved
        assert golden("--signature", "--cpu", "interpreter", "--play-states", self.states) == self.saved

    def test_a_state_of_another_moment_has_another_digest(self):
        swapped = pathlib.Path(self.states.parent, "swapped")
        swapped.mkdir()
        files = sorted(self.states.iterdir())
        for path in files:
            (swapped / path.name).write_bytes(path.read_bytes())
        # The last works are settings of one game, whose states its machines accept.
        one, other = (swapped / f"{len(files) - number}.state" for number in (5, 6))
        one.write_bytes(other.read_bytes())
        status, digest, errors = golden("--play-states", swapped)
        assert (status, errors) == (0, "")
        assert digest != self.saved[1]

    def test_a_state_that_is_altered_or_missing_is_named(self):
        altered = pathlib.Path(self.states.parent, "altered")
        altered.mkdir()
        status, _, errors = golden("--play-states", altered)
        assert (status, errors) == (1, f"golden: cannot read {altered}/0.state")
        state = bytearray((self.states / "0.state").read_bytes())
        state[-1] ^= 1
        (altered / "0.state").write_bytes(state)
        status, _, errors = golden("--play-states", altered)
        assert status == 1
        assert re.search(f"^golden: {altered}/0.state: .*altered", errors)
