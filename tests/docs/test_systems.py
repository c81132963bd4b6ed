"""The sources of the systems in system/ define the same functions, although a build compiles those of one system."""

import re

import pytest
from tree import ROOT

FOLDERS = ("darwin", "wasm", "windows")  # what they lack is taken from linux/

# Functions that a system lacks, and why.
LACKING = {
    "wasm/resources.cpp": {
        "open_spare_file",
        "process_number",
        "return_large_blocks",
        "trim_heap",
    },  # for the program only
}


def without_comments(path):
    return re.sub(r"//.*", "", path.read_text())


def declared(folder, name):
    """The words of a header: the names of what it declares are among them."""
    headers = [path for path in (folder / f"{name}.hpp", folder / f"program/{name}.hpp") if path.exists()]
    return set(re.findall(r"~?\w+", without_comments(headers[0]))) if headers else set()


def defined(path):
    """The functions whose definitions begin without indentation, with the names of their classes."""
    line = r"^(?!namespace\b|#)[\w\[].*?\b((?:\w+::)*~?\w+)\("
    return set(re.findall(line, without_comments(path), re.MULTILINE))


def faults(folder=ROOT / "system", lacking=LACKING):
    """Lists functions that a header declares and linux/ defines, but that the same source of another system lacks."""
    missing = {}
    for system in FOLDERS:
        for path in sorted((folder / system).glob("*.cpp")):
            linux = folder / "linux" / path.name
            words = declared(folder, path.stem)
            required = {name for name in defined(linux) if name.split("::")[-1] in words} if linux.exists() else set()
            if required - defined(path):
                missing[f"{system}/{path.name}"] = required - defined(path)
    return [
        f"{source}: {name}"
        for source in sorted({*missing, *lacking})
        for name in sorted(missing.get(source, set()) ^ lacking.get(source, set()))
    ]


class TestThisTree:
    def test_each_system_defines_what_linux_defines(self):
        assert faults() == []

    def test_the_check_sees_the_definitions(self):
        found = [
            declared(ROOT / "system", path.stem) & {name.split("::")[-1] for name in defined(path)}
            for path in (ROOT / "system/windows").glob("*.cpp")
            if path.stem != "files"  # only for other sources of the folder
        ]
        assert len(found) > 10
        assert all(found)


class TestTheCheck:
    @pytest.fixture(autouse=True)
    def set_up(self, tmp_path):
        self.root = tmp_path
        self.write("clock.hpp", "double seconds();\nclass Watch {\n  Watch();\n  int laps() const;\n};\n")
        self.write(
            "linux/clock.cpp",
            "double seconds() { return 1; }\nWatch::Watch() = default;\nint Watch::laps() const {\n}\n",
        )

    def write(self, name, text):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def faults(self, lacking=None):
        return faults(self.root, lacking or {})

    def test_the_same_functions_are_accepted(self):
        self.write(
            "windows/clock.cpp", "int Watch::laps() const { return 0; }\nWatch::Watch() {}\ndouble seconds() {\n}\n"
        )
        assert self.faults() == []

    def test_a_function_of_another_name_is_named(self):
        self.write("windows/clock.cpp", "Watch::Watch() {}\nint Watch::rounds() const {\n}\ndouble seconds() {\n}\n")
        assert self.faults() == ["windows/clock.cpp: Watch::laps"]

    def test_a_call_or_a_comment_does_not_define(self):
        self.write(
            "darwin/clock.cpp", "Watch::Watch() {}\nint Watch::laps() const {\n  seconds();\n}\n// double seconds()\n"
        )
        assert self.faults() == ["darwin/clock.cpp: seconds"]
        assert self.faults({"darwin/clock.cpp": {"seconds"}}) == []

    def test_a_lack_that_there_is_not_is_named(self):
        assert self.faults({"wasm/clock.cpp": {"seconds"}}) == ["wasm/clock.cpp: seconds"]

    def test_a_function_that_only_linux_has_is_not_required(self):
        self.write("linux/clock.cpp", "int ticks() { return 1; }\n")
        self.write("windows/clock.cpp", "int frequency() { return 1; }\n")
        assert self.faults() == []
