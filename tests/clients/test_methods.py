"""Every client has a method for each command of the protocol, and knows each field of bytes."""

import pathlib
import re
import sys

SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(SOURCE / "clients/conformance"), str(SOURCE / "protocol/description")]

import coverage  # noqa: E402
import description  # noqa: E402
from harness import BINARY  # noqa: E402

# The files of a client, and what its methods look like.
METHODS = {
    "python": (("python/racebeam/wire/commands.py",), r"^    def (\w+)\("),
    "java": (
        ("java/src/main/java/racebeam/Session.java", "java/src/main/java/racebeam/Commands.java"),
        r"^  public [\w<>\[\], ]+ (\w+)\(",
    ),
    "lua": (("lua/racebeam/init.lua", "lua/racebeam/commands.lua"), r"^function (?:Session|methods):(\w+)\("),
    "c++": (("cpp/racebeam/client/commands.hpp", "cpp/racebeam/client/command_methods.hpp"), r"^  auto (\w+)\("),
    "javascript": (("js/src/session.js", "js/src/commands.js"), r"^  (?:async )?(\w+)\("),
    "typescript": (("js/src/index.d.ts",), r"^  (\w+)\("),
}
TABLES = (
    "python/racebeam/wire/fields.py",
    "java/src/main/java/racebeam/FieldTable.java",
    "lua/racebeam/field_table.lua",
    "cpp/racebeam/client/field_table.hpp",
    "js/src/field_table.js",
    "shell/racebeam.bash",
)


def text(path):
    return (SOURCE / "clients" / path).read_text()


def plain(name):
    """A name without the style of its language."""
    return name.replace("_", "").lower()


class TestMethods:
    def test_every_command_has_a_method_in_every_client(self):
        protocol = description.read()
        assert [command.name for command in protocol.commands] == coverage.expected(BINARY)["command"]
        for client, (paths, pattern) in METHODS.items():
            methods = {plain(name) for path in paths for name in re.findall(pattern, text(path), re.MULTILINE)}
            assert [command.name for command in protocol.commands if plain(command.method) not in methods] == [], client

    def test_the_types_of_methods_that_a_person_wrote_have_each_key(self):
        declared = {plain(line.split("(")[0]): line for line in text("js/src/index.d.ts").splitlines() if "(" in line}
        for command in description.read().commands:
            if command.returns == "own" and not any(argument.type == "settings" for argument in command.arguments):
                for argument in (*command.keys, *command.old_keys):
                    assert re.search(rf"\b{argument.key}\?:", declared[plain(f"  {command.method}")])

    def test_every_client_knows_each_field_of_bytes(self):
        for field in description.read().byte_fields:
            for path in TABLES:
                assert re.search(rf"\b{field.name}\b", text(path)), path
