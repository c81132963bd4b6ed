"""One version: project(VERSION) of CMakeLists.txt, in the program, its greeting, and the packages of all clients."""

import importlib.machinery
import importlib.util
import os
import pathlib
import re
import shutil
import subprocess

import pytest
import tomllib

ROOT = pathlib.Path(__file__).resolve().parents[2]
BINARY = os.environ["RACEBEAM_BINARY"]


def script(name):
    """A program of scripts/ as a module."""
    loader = importlib.machinery.SourceFileLoader(name, str(ROOT / "scripts" / name))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(name, loader))
    loader.exec_module(module)
    return module


version = script("version")


class TestVersion:
    def test_the_program_says_it(self):
        output = subprocess.run([BINARY, "--version"], capture_output=True, text=True, check=True).stdout
        assert output == f"racebeam {version.decided()}\n"

    def test_the_greeting_says_it(self):
        output = subprocess.run(
            [BINARY, "serve", "--stdio"], input="hello\nquit\n", capture_output=True, text=True, check=True
        ).stdout
        assert f" server=racebeam/{version.decided()} " in output

    def test_the_clients_have_it(self):
        assert version.differences() == []

    def test_the_changelog_has_a_section_with_its_date(self):
        heading = rf"(?m)^## \[{re.escape(version.decided())}\] - \d{{4}}-\d\d-\d\d$"
        assert re.search(heading, (ROOT / "CHANGELOG.md").read_text())

    def test_the_wheel_takes_it_from_cmake(self):
        project = tomllib.loads((ROOT / "pyproject.toml").read_text())
        assert "version" in project["project"]["dynamic"]
        source = project["tool"]["scikit-build"]["metadata"]["version"]
        assert source["input"] == "CMakeLists.txt"
        found = re.search(source["regex"], (ROOT / "CMakeLists.txt").read_text(), re.MULTILINE)
        assert found["value"] == version.decided()


class TestScript:
    """A new version reaches each place."""

    @pytest.fixture(autouse=True)
    def set_up(self, tmp_path):
        self.root = tmp_path
        for name, _ in (*version.PLACES, ("CMakeLists.txt", "")):
            path = version.path_of(ROOT, name)
            copy = self.root / path.relative_to(ROOT)
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(path, copy)
        cmake = self.root / "CMakeLists.txt"
        cmake.write_text(cmake.read_text().replace(f"VERSION {version.decided()}", "VERSION 12.3.4", 1))

    def test_each_place_that_differs_is_named(self):
        wrong = "\n".join(version.differences(self.root))
        for name, _ in version.PLACES:
            assert str(version.path_of(self.root, name).relative_to(self.root)) in wrong

    def test_write_changes_them(self):
        version.differences(self.root, write=True)
        assert version.differences(self.root) == []
        assert (self.root / "clients/lua/racebeam-12.3.4-1.rockspec").exists()
        assert "<version>12.3.4</version>" in (self.root / "clients/java/pom.xml").read_text()
