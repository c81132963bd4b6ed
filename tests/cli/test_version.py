"""One version: project(VERSION) of CMakeLists.txt, in the program, its greeting, and the packages of all clients."""

import importlib.machinery
import importlib.util
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

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


class Version(unittest.TestCase):
    def test_the_program_says_it(self):
        output = subprocess.run([BINARY, "--version"], capture_output=True, text=True, check=True).stdout
        self.assertEqual(output, f"racebeam {version.decided()}\n")

    def test_the_greeting_says_it(self):
        output = subprocess.run(
            [BINARY, "serve", "--stdio"], input="hello\nquit\n", capture_output=True, text=True, check=True
        ).stdout
        self.assertIn(f" server=racebeam/{version.decided()} ", output)

    def test_the_clients_have_it(self):
        self.assertEqual(version.differences(), [])

    def test_the_changelog_has_a_section_with_its_date(self):
        heading = rf"(?m)^## \[{re.escape(version.decided())}\] - \d{{4}}-\d\d-\d\d$"
        self.assertRegex((ROOT / "CHANGELOG.md").read_text(), heading)

    def test_the_wheel_takes_it_from_cmake(self):
        project = tomllib.loads((ROOT / "pyproject.toml").read_text())
        self.assertIn("version", project["project"]["dynamic"])
        source = project["tool"]["scikit-build"]["metadata"]["version"]
        self.assertEqual(source["input"], "CMakeLists.txt")
        found = re.search(source["regex"], (ROOT / "CMakeLists.txt").read_text(), re.MULTILINE)
        self.assertEqual(found["value"], version.decided())


class Script(unittest.TestCase):
    """A new version reaches each place."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
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
            self.assertIn(str(version.path_of(self.root, name).relative_to(self.root)), wrong)

    def test_write_changes_them(self):
        version.differences(self.root, write=True)
        self.assertEqual(version.differences(self.root), [])
        self.assertTrue((self.root / "clients/lua/racebeam-12.3.4-1.rockspec").exists())
        self.assertIn("<version>12.3.4</version>", (self.root / "clients/java/pom.xml").read_text())


if __name__ == "__main__":
    unittest.main(verbosity=2)
