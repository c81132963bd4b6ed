"""The tree's shape: folders of limited size, and links that stay inside the tree."""

import os
import pathlib
import shutil
import subprocess

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
MOST_SUBJECTS = 25
NOT_OURS = {"build", "__pycache__", "node_modules"}  # and names that begin with a dot
DATA = ("games/catalogue", "fuzz/corpora", "docs/spec")  # folders of files of one kind


def folders(root):
    """Each folder below `root` that holds sources, relative to it, with its folders and files."""
    for path, inside, files in os.walk(root):
        inside[:] = [name for name in inside if name not in NOT_OURS and not name.startswith(".")]
        yield pathlib.Path(path).relative_to(root), inside, [name for name in files if not name.startswith(".")]


def subjects(inside, files):
    """The subjects of a folder. A header and its source are one; so is a folder. At the root, only folders count:
    readers and tools look for its files there."""
    return {pathlib.Path(name).stem for name in files} | set(inside)


def crowded(root):
    """The folders with too many subjects, with their number."""
    found = {}
    for path, inside, files in folders(root):
        count = len(subjects(inside, files if path.name else []))
        if count > MOST_SUBJECTS and not path.as_posix().startswith(DATA):
            found[path.as_posix()] = count
    return found


def leaving_links(root):
    """Symbolic links that are absolute, or lead out of `root`."""
    links = [
        root / path / name
        for path, inside, files in folders(root)
        for name in inside + files
        if (root / path / name).is_symlink()
    ]
    return [
        link.relative_to(root).as_posix()
        for link in links
        if os.path.isabs(os.readlink(link)) or not link.resolve().is_relative_to(root.resolve())
    ]


# A room, and a room above it that it must not use.
ONE_WAY = {"protocol/line": "protocol/line/commands"}


def arrows_back(root):
    """Files that include a file of a room above their own."""
    return [
        path.relative_to(root).as_posix()
        for room, user in ONE_WAY.items()
        for path in sorted((root / room).glob("*.[hc]pp"))
        if f'#include "{user}/' in path.read_text()
    ]


class TestTree:
    def test_no_room_uses_one_above_it(self):
        assert arrows_back(ROOT) == []

    def test_no_folder_has_too_many_subjects(self):
        assert crowded(ROOT) == {}

    @pytest.mark.skipif(not ((ROOT / ".git").exists() and shutil.which("git")), reason="this is not a checkout")
    def test_nothing_that_is_ignored_is_in_the_tree(self):
        command = ["git", "ls-files", "--cached", "--ignored", "--exclude-standard"]
        output = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout
        assert output.splitlines() == []

    def test_no_link_leads_out(self):
        assert leaving_links(ROOT) == []


class TestChecks:
    """Tests of the two checks themselves."""

    @pytest.fixture(autouse=True)
    def set_up(self, tmp_path):
        self.root = tmp_path

    def fill(self, name, count):
        (self.root / name).mkdir(parents=True)
        for number in range(count):
            for ending in ("hpp", "cpp"):
                (self.root / name / f"subject{number}.{ending}").touch()

    def test_a_crowded_folder_is_named(self):
        self.fill("full", MOST_SUBJECTS)
        self.fill("crowded", MOST_SUBJECTS + 1)
        self.fill("fuzz/corpora/image", MOST_SUBJECTS + 1)
        self.fill("build", MOST_SUBJECTS + 1)
        assert crowded(self.root) == {"crowded": MOST_SUBJECTS + 1}

    def test_an_arrow_back_is_named(self):
        self.fill("protocol/line/commands", 1)
        for name, include in (("good", "words"), ("bad", "commands/help")):
            (self.root / f"protocol/line/{name}.cpp").write_text(f'#include "protocol/line/{include}.hpp"\n')
        assert arrows_back(self.root) == ["protocol/line/bad.cpp"]

    def test_a_link_that_leaves_is_named(self):
        self.fill("room", 1)
        for name, target in (
            ("inside", "subject0.hpp"),
            ("absolute", str(self.root / "room/subject0.hpp")),
            ("outside", "../../elsewhere"),
        ):
            (self.root / "room" / name).symlink_to(target)
        assert sorted(leaving_links(self.root)) == ["room/absolute", "room/outside"]
