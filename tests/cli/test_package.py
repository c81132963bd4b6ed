"""The package of Debian, and the texts that it brings: man pages, completions, units of systemd."""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

import pytest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "tests/server"))

from harness import BINARY  # noqa: E402

BUILD = pathlib.Path(BINARY).parent
PLAIN = {key: value for key, value in os.environ.items() if not key.startswith("RACEBEAM_")}
pytestmark = pytest.mark.needs_programs("dpkg-deb", "cpack")

OURS = {"beamfall", "updraft"}  # images that may be distributed; they are inside the program


def output(*command, **options):
    return subprocess.run(
        [str(word) for word in command], capture_output=True, text=True, check=True, **{"env": PLAIN, **options}
    ).stdout


class Package(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        cls.first, cls.second = cls.packed("first"), cls.packed("second")
        cls.root = cls.folder / "root"
        output("dpkg-deb", "-x", cls.first, cls.root)

    @classmethod
    def packed(cls, name):
        output(
            "cpack",
            "--config",
            BUILD / "CPackConfig.cmake",
            "-G",
            "DEB",
            "-B",
            cls.folder / name,
            cwd=BUILD,
            env={**PLAIN, "SOURCE_DATE_EPOCH": "1700000000"},
        )
        return next((cls.folder / name).glob("*.deb"))

    def test_its_name_has_the_version(self):
        version = output(BINARY, "--version").split()[1]
        self.assertEqual(self.first.name, f"racebeam-{version}.deb")
        self.assertEqual(
            output("dpkg-deb", "-f", self.first, "Package", "Version"), f"Package: racebeam\nVersion: {version}\n"
        )

    def test_two_runs_give_the_same_bytes(self):
        self.assertEqual(self.first.read_bytes(), self.second.read_bytes())

    def test_its_program_plays(self):
        info = output(
            self.root / "usr/bin/racebeam", "serve", "--stdio", input="load beamfall seed=7 sticky=0\nact FIRE*60\n"
        )
        self.assertEqual(info.splitlines()[-1], "ok reward=21 terminated=0 truncated=0 lives=4")

    def test_it_has_no_image_but_ours(self):
        names = [path.name for path in self.root.rglob("*") if path.is_file()]
        self.assertFalse([name for name in names if name.endswith((".bin", ".a26", ".rom", ".gz", ".zip"))])
        reply = output(self.root / "usr/bin/racebeam", "serve", "--stdio", input="games\n")
        self.assertEqual(set(reply.rpartition("games=")[2].strip().split(",")), OURS)

    def test_its_settings_are_accepted(self):
        path = self.root / "etc/racebeam.toml"
        self.assertIn('roms = "/var/lib/racebeam"', output(BINARY, "config", "--config", path))
        self.assertEqual(output("dpkg-deb", "-I", self.first, "conffiles"), "/etc/racebeam.toml\n")

    def test_its_units_belong_together(self):
        units = self.root / "lib/systemd/system"
        service = (units / "racebeam.service").read_text()
        self.assertIn("ExecStart=/usr/bin/racebeam serve --listen systemd:line --config /etc/racebeam.toml\n", service)
        self.assertIn("FileDescriptorName=line\n", (units / "racebeam.socket").read_text())
        for line in (
            "User=racebeam",
            "ProtectSystem=strict",
            "NoNewPrivileges=yes",
            "SystemCallFilter=@system-service",
        ):
            self.assertIn(line + "\n", service)

    def test_its_scripts_are_those_of_a_shell(self):
        for name in ("postinst", "prerm", "postrm"):
            output("sh", "-n", SOURCE / "packages/debian" / name)
            self.assertIn("set -e", output("dpkg-deb", "-I", self.first, name))

    def test_there_is_a_man_page_for_each_subcommand(self):
        subcommands = output(BINARY, "--help").partition("Subcommands:")[2].partition("\n\n")[0]
        names = {line.split()[0] for line in subcommands.splitlines() if line.startswith("  ") and line[2] != " "}
        self.assertIn("serve", names)
        pages = self.root / "usr/share/man/man1"
        self.assertEqual(
            {path.name for path in pages.iterdir()}, {"racebeam.1", *(f"racebeam-{name}.1" for name in names)}
        )
        self.assertIn(r"\-\-frame\-skip", (pages / "racebeam-serve.1").read_text())
        protocol = self.root / "usr/share/man/man7/racebeam-protocol.7"
        if shutil.which("groff"):
            for page in (*pages.iterdir(), protocol):
                done = subprocess.run(["groff", "-man", "-ww", "-Tutf8", page], capture_output=True, text=True)
                self.assertEqual((done.returncode, done.stderr), (0, ""), page)
                self.assertIn("racebeam", done.stdout)


class Completion(unittest.TestCase):
    """What the completion of bash offers."""

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = pathlib.Path(folder.name)
        output(sys.executable, "-B", SOURCE / "packages/program_text.py", BINARY, cls.folder)

    def completions(self, *words):
        script = 'source "$1"; shift; COMP_WORDS=(racebeam "$@"); COMP_CWORD=$#; _racebeam; '
        script += 'printf "%s\\n" "${COMPREPLY[@]}"'
        environment = {**PLAIN, "PATH": f"{BUILD}:{PLAIN['PATH']}"}
        return output("bash", "-c", script, "bash", self.folder / "racebeam.bash", *words, env=environment).split()

    def test_subcommands(self):
        self.assertEqual(self.completions("ser"), ["serve"])
        self.assertIn("games", self.completions(""))

    def test_options_of_the_subcommand(self):
        self.assertEqual(self.completions("serve", "--frame"), ["--frame-skip"])
        self.assertEqual(self.completions("games", "--frame"), [])

    def test_games(self):
        self.assertEqual(self.completions("trace", "--game", "beamf"), ["beamfall"])
        self.assertIn("pong", self.completions("trace", "--game", ""))

    def test_the_others_name_the_same_options(self):
        for name in ("_racebeam", "racebeam.fish"):
            text = (self.folder / name).read_text()
            for word in ("serve", "frame-skip", "racebeam games"):
                self.assertIn(word, text, name)
        for shell, name in (("zsh", "_racebeam"), ("fish", "racebeam.fish")):
            if shutil.which(shell):
                output(shell, "-n", self.folder / name)
