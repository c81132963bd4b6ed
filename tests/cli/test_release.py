"""scripts/release: what it makes of a build that is there. The build itself takes long, and is left out here."""

import argparse
import hashlib
import importlib.machinery
import importlib.util
import json
import pathlib
import re
import subprocess
import tarfile

import pytest

SOURCE = pathlib.Path(__file__).resolve().parents[2]

from harness import BINARY

BUILD = pathlib.Path(BINARY).parent


def script(name):
    """A program of scripts/ as a module."""
    loader = importlib.machinery.SourceFileLoader(name, str(SOURCE / "scripts" / name))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(name, loader))
    loader.exec_module(module)
    return module


def in_git():
    return subprocess.run(["git", "rev-parse", "HEAD"], cwd=SOURCE, capture_output=True).returncode == 0


pytestmark = [
    pytest.mark.slow,
    pytest.mark.needs_programs("dpkg-deb", "cpack"),
    pytest.mark.skipif(not in_git(), reason="not found: git"),
]


class TestRelease:
    @pytest.fixture(scope="class", autouse=True)
    @classmethod
    def set_up_class(cls, tmp_path_factory):
        folder = tmp_path_factory.mktemp("release")
        cls.folder = folder
        cls.release = script("release").Release("HEAD", 1)
        cls.release.build = cls.release.python = lambda *_: None
        cls.release.pack = lambda machine, _, __, scratch, into, pack=cls.release.pack: pack(
            machine, BUILD, BUILD, scratch, into
        )
        for name in ("first", "second"):
            (cls.folder / name).mkdir()
            cls.release.make(cls.folder / name)
        cls.packages = cls.folder / "first"
        cls.version = cls.release.version

    def unpacked(self, pattern):
        path = next(self.packages.glob(pattern))
        with tarfile.open(path) as archive:
            archive.extractall(self.folder / path.name)
        return next((self.folder / path.name).iterdir())

    def test_all_packages_are_there(self):
        kinds = {
            f"racebeam-{self.version}.deb",
            f"racebeam-{self.version}-source.tar.gz",
            "racebeam.rb",
            "PKGBUILD",
            "sbom.json",
            "SHA256SUMS",
        }
        names = {path.name for path in self.packages.iterdir()}
        assert kinds <= names, names
        assert len(names - kinds) == 1  # that of the processor

    def test_two_runs_give_the_same_sums(self):
        assert (self.packages / "SHA256SUMS").read_text() == (self.folder / "second/SHA256SUMS").read_text()

    def test_the_sums_are_those_of_the_files(self):
        lines = (self.packages / "SHA256SUMS").read_text().splitlines()
        assert len(lines) == len(list(self.packages.iterdir())) - 1
        for line in lines:
            digest, name = line.split()
            assert hashlib.sha256((self.packages / name).read_bytes()).hexdigest() == digest

    def test_the_program_plays_where_it_is_unpacked(self):
        program = self.unpacked("*-linux-*.tar.gz") / "bin/racebeam"
        output = subprocess.run(
            [program, "serve", "--stdio"],
            input="load beamfall seed=7 sticky=0\nact FIRE*60\n",
            capture_output=True,
            text=True,
        )
        assert output.stdout.splitlines()[-1] == "ok reward=21 terminated=0 truncated=0 lives=4"

    def test_a_link_that_leads_nowhere_is_refused(self, tmp_path):
        (tmp_path / "librace.so.1").touch()
        (tmp_path / "librace.so").symlink_to("librace.so.1")
        check = script("release").check_links
        check(tmp_path)
        (tmp_path / "librace.so.1").unlink()
        with pytest.raises(FileNotFoundError, match="librace.so leads to librace.so.1"):
            check(tmp_path)

    def test_the_source_is_that_of_the_commit(self):
        source = self.unpacked("*-source.tar.gz")
        output = subprocess.run(
            ["git", "ls-tree", "-r", "--name-only", "HEAD"], cwd=SOURCE, capture_output=True, text=True, check=True
        ).stdout
        assert {str(path.relative_to(source)) for path in source.rglob("*") if not path.is_dir()} == set(
            output.splitlines()
        )

    def test_the_texts_name_the_source(self):
        digest = hashlib.sha256(next(self.packages.glob("*-source.tar.gz")).read_bytes()).hexdigest()
        for name in ("racebeam.rb", "PKGBUILD"):
            text = (self.packages / name).read_text()
            assert digest in text
            assert self.version in text
            assert not re.search("@[A-Z]", text)  # a mark that was left
        subprocess.run(["bash", "-n", self.packages / "PKGBUILD"], check=True)

    def test_the_parts_have_versions(self):
        contents = json.loads((self.packages / "sbom.json").read_text())
        assert (contents["bomFormat"], contents["specVersion"], contents["metadata"]["component"]["version"]) == (
            "CycloneDX",
            "1.5",
            self.version,
        )
        names = {part["name"] for part in contents["components"]}
        assert {"libc6", "libssl3", "zlib1g", "Boost headers"} <= names, names
        assert all(part["version"] and part["purl"].startswith("pkg:deb/debian/") for part in contents["components"])


class Stub:
    """Makes a release of one file, or fails in the middle."""

    def __init__(self, fails=False):
        self.fails = fails

    def make(self, into):
        (into / "new").touch()
        if self.fails:
            raise subprocess.CalledProcessError(1, "cmake")
        (into / "SHA256SUMS").write_text("sums\n")


class TestFolder:
    @pytest.fixture(autouse=True)
    def set_up(self, tmp_path):
        self.into = tmp_path / "packages"
        self.script = script("release")

    def test_a_release_replaces_an_earlier_one_when_it_is_whole(self):
        assert self.script.make_in(self.into, Stub()) == "sums\n"
        (self.into / "new").rename(self.into / "old")
        with pytest.raises(subprocess.CalledProcessError):
            self.script.make_in(self.into, Stub(fails=True))
        assert {path.name for path in self.into.iterdir()} == {"old", "SHA256SUMS"}
        self.script.make_in(self.into, Stub())
        assert {path.name for path in self.into.iterdir()} == {"new", "SHA256SUMS"}
        assert list(self.into.parent.iterdir()) == [self.into]

    def test_a_folder_with_files_of_others_is_refused(self):
        assert self.script.release_folder(str(self.into)) == self.into
        self.into.mkdir()
        assert self.script.release_folder(str(self.into)) == self.into
        (self.into / "thesis.tex").touch()
        with pytest.raises(argparse.ArgumentTypeError, match="since it lacks SHA256SUMS; expected"):
            self.script.release_folder(str(self.into))
        (self.into / "SHA256SUMS").touch()
        assert self.script.release_folder(str(self.into)) == self.into
