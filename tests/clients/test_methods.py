"""Every client has a method for each command of the protocol."""

import pathlib
import re
import sys
import unittest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(SOURCE / "tests/server"), str(SOURCE / "clients/conformance")]

import coverage  # noqa: E402
from harness import BINARY, main  # noqa: E402

# The file of a client, and what its methods look like.
METHODS = {
    "python": ("python/racebeam/wire/client.py", r"^    def (\w+)\(self"),
    "java": ("java/src/main/java/racebeam/Session.java", r"^  public [\w<>\[\], ]+ (\w+)\("),
    "lua": ("lua/racebeam/init.lua", r"^function Session:(\w+)\("),
    "c++": ("cpp/racebeam/client/commands.hpp", r"^  auto (\w+)\("),
    "javascript": ("js/src/session.js", r"^  (?:async )?(\w+)\("),
    "typescript": ("js/src/index.d.ts", r"^  (\w+)\("),
}
# Words that languages reserve, and methods that end the session.
RENAMED = {"export": "export_state", "import": "import_state", "close": "close_machines"}


def plain(name):
    """A name without the style of its language."""
    return name.replace("_", "").lower()


class Methods(unittest.TestCase):
    def test_every_command_has_a_method_in_every_client(self):
        commands = coverage.expected(BINARY)["command"]
        self.assertGreater(len(commands), 30)
        for client, (path, pattern) in METHODS.items():
            methods = {plain(name) for name in re.findall(pattern, (SOURCE / "clients" / path).read_text(), re.MULTILINE)}
            missing = [name for name in commands if not {plain(name), plain(RENAMED.get(name, name))} & methods]
            self.assertEqual(missing, [], client)


if __name__ == "__main__":
    main()
