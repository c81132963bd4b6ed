"""Each type has its own name in its namespace. Two definitions make the program ill-formed, without a
diagnostic."""

import collections
import pathlib
import re

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDERS = (
    "system",
    "emulator",
    "games",
    "environment",
    "include",
    "library",
    "recording",
    "protocol",
    "server",
    "agents",
    "cli",
)  # one program

OPENS = re.compile(r"(?:inline )?namespace ?([\w:]*) ?\{$")
CLOSES = re.compile(r"\}  // namespace")
DEFINES = re.compile(r"(?:struct|class|enum|enum class|union) (?:alignas\(\w+\) )?(\w+)(?: final)?(?: ?:[^:].*)? ?\{")


def types(path):
    """The types that a file defines outside of other types and of unnamed namespaces, with their full
    names."""
    namespaces = []
    for line in path.read_text().splitlines():
        if found := OPENS.match(line):
            namespaces.append(found[1])
        elif CLOSES.match(line):
            namespaces.pop()
        elif (found := DEFINES.match(line)) and all(namespaces):
            yield "::".join([*namespaces, found[1]])


def defined_twice(root):
    """Names with several definitions, and the files of these."""
    files = collections.defaultdict(list)
    for folder in FOLDERS:
        for path in sorted((root / folder).rglob("*.[hc]pp")):
            for name in types(path):
                files[name].append(path.relative_to(root).as_posix())
    return {name: where for name, where in files.items() if len(where) > 1}


class TestNames:
    def test_no_type_is_defined_twice(self):
        assert defined_twice(ROOT) == {}


class TestCheck:
    """Tests of the check itself."""

    @pytest.fixture(autouse=True)
    def set_up(self, tmp_path):
        self.root = tmp_path

    def write(self, path, *lines):
        (self.root / path).parent.mkdir(exist_ok=True)
        (self.root / path).write_text("\n".join(("namespace racebeam {", *lines, "}  // namespace racebeam")))

    def test_two_types_of_one_name_are_found(self):
        self.write("emulator/a.hpp", "struct Drawing {", "};")
        self.write("environment/b.hpp", "enum class Drawing { kOne };")
        assert defined_twice(self.root) == {"racebeam::Drawing": ["emulator/a.hpp", "environment/b.hpp"]}

    def test_others_may_have_the_name(self):
        self.write("emulator/a.hpp", "class Drawing : public Base {", "};")
        self.write("emulator/b.hpp", "class Drawing;", "struct Drawing::Impl {", "};")
        self.write("emulator/c.cpp", "namespace {", "struct Drawing {", "};", "}  // namespace")
        self.write("emulator/d.cpp", "namespace inner {", "struct Drawing {", "};", "}  // namespace inner")
        assert defined_twice(self.root) == {}
