"""The package of Debian, and the texts that it brings: man pages, completions, units of systemd."""

import os
import pathlib
import shutil
import subprocess
import sys

import cartridges
import pytest

SOURCE = pathlib.Path(__file__).resolve().parents[2]

from harness import BINARY

BUILD = pathlib.Path(BINARY).parent
PLAIN = {key: value for key, value in os.environ.items() if not key.startswith("RACEBEAM_")}
pytestmark = pytest.mark.needs_programs("dpkg-deb", "cpack")


def output(*command, **options):
    return subprocess.run(
        [str(word) for word in command], capture_output=True, text=True, check=True, **{"env": PLAIN, **options}
    ).stdout


class TestPackage:
    @pytest.fixture(scope="class", autouse=True)
    @classmethod
    def set_up_class(cls, tmp_path_factory):
        folder = tmp_path_factory.mktemp("package")
        cls.folder = folder
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
        assert self.first.name == f"racebeam-{version}.deb"
        assert output("dpkg-deb", "-f", self.first, "Package", "Version") == f"Package: racebeam\nVersion: {version}\n"

    def test_two_runs_give_the_same_bytes(self):
        assert self.first.read_bytes() == self.second.read_bytes()

    def test_its_program_plays(self):
        info = output(
            self.root / "usr/bin/racebeam", "serve", "--stdio", input="load beamfall seed=7 sticky=0\nact FIRE*60\n"
        )
        assert info.splitlines()[-1] == "ok reward=21 terminated=0 truncated=0 lives=4"

    def test_it_has_no_image_but_ours(self):
        names = [path.name for path in self.root.rglob("*") if path.is_file()]
        assert not [name for name in names if name.endswith((".bin", ".a26", ".rom", ".gz", ".zip"))]
        reply = output(self.root / "usr/bin/racebeam", "serve", "--stdio", input="games\n")
        assert set(reply.rpartition("games=")[2].strip().split(",")) == set(cartridges.OURS)

    def test_its_settings_are_accepted(self):
        path = self.root / "etc/racebeam.toml"
        assert 'roms = "/var/lib/racebeam"' in output(BINARY, "config", "--config", path)
        assert output("dpkg-deb", "-I", self.first, "conffiles") == "/etc/racebeam.toml\n"

    def test_its_units_belong_together(self):
        units = self.root / "lib/systemd/system"
        service = (units / "racebeam.service").read_text()
        assert "ExecStart=/usr/bin/racebeam serve --listen systemd:line --config /etc/racebeam.toml\n" in service
        assert "FileDescriptorName=line\n" in (units / "racebeam.socket").read_text()
        for line in (
            "User=racebeam",
            "ProtectSystem=strict",
            "NoNewPrivileges=yes",
            "SystemCallFilter=@system-service",
        ):
            assert line + "\n" in service

    def test_its_scripts_are_those_of_a_shell(self):
        for name in ("postinst", "prerm", "postrm"):
            output("sh", "-n", SOURCE / "packages/debian" / name)
            assert "set -e" in output("dpkg-deb", "-I", self.first, name)

    def test_there_is_a_man_page_for_each_subcommand(self):
        subcommands = output(BINARY, "--help").partition("Subcommands:")[2].partition("\n\n")[0]
        names = {line.split()[0] for line in subcommands.splitlines() if line.startswith("  ") and line[2] != " "}
        assert "serve" in names
        pages = self.root / "usr/share/man/man1"
        assert {path.name for path in pages.iterdir()} == {"racebeam.1", *(f"racebeam-{name}.1" for name in names)}
        assert r"\-\-frame\-skip" in (pages / "racebeam-serve.1").read_text()
        protocol = self.root / "usr/share/man/man7/racebeam-protocol.7"
        if shutil.which("groff"):
            for page in (*pages.iterdir(), protocol):
                done = subprocess.run(["groff", "-man", "-ww", "-Tutf8", page], capture_output=True, text=True)
                assert (done.returncode, done.stderr) == (0, ""), page
                assert "racebeam" in done.stdout


class TestCompletion:
    """What the completion of bash offers."""

    @pytest.fixture(scope="class", autouse=True)
    @classmethod
    def set_up_class(cls, tmp_path_factory):
        folder = tmp_path_factory.mktemp("completion")
        cls.folder = folder
        output(sys.executable, "-B", SOURCE / "packages/program_text.py", cls.folder, BINARY)

    def completions(self, *words):
        script = 'source "$1"; shift; COMP_WORDS=(racebeam "$@"); COMP_CWORD=$#; _racebeam; '
        script += 'printf "%s\\n" "${COMPREPLY[@]}"'
        environment = {**PLAIN, "PATH": f"{BUILD}:{PLAIN['PATH']}"}
        return output("bash", "-c", script, "bash", self.folder / "racebeam.bash", *words, env=environment).split()

    def test_subcommands(self):
        assert self.completions("ser") == ["serve"]
        assert "games" in self.completions("")

    def test_options_of_the_subcommand(self):
        assert self.completions("serve", "--frame") == ["--frame-skip"]
        assert self.completions("games", "--frame") == []

    def test_games(self):
        assert self.completions("trace", "--game", "beamf") == ["beamfall"]
        assert "pong" in self.completions("trace", "--game", "")

    def test_the_others_name_the_same_options(self):
        for name in ("_racebeam", "racebeam.fish"):
            text = (self.folder / name).read_text()
            for word in ("serve", "frame-skip", "racebeam games"):
                assert word in text, name
        for shell, name in (("zsh", "_racebeam"), ("fish", "racebeam.fish")):
            if shutil.which(shell):
                output(shell, "-n", self.folder / name)
