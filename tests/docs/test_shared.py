"""docs/architecture.md lists all mutable objects that machines share."""

import os
import pathlib
import re
import subprocess

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ["RACEBEAM_BINARY"]).parent
LIBRARIES = [BUILD / f"{name}/libracebeam_{name}.a" for name in ("emulator", "environment")]
CACHE = (BUILD / "CMakeCache.txt").read_text() if (BUILD / "CMakeCache.txt").exists() else ""
LISTED = ROOT / "docs/architecture.md"

# Functions and objects that hold values which are computed once or by the compiler, and then only read.
CONSTANTS = {"PixelMask::kBelow", "blend", "kSettings", "simd", "supported_simd", "executable_memory_error"}

MEMBER = re.compile(r"^(?P<file>\S+\.cpp)\.o: +file format")
OBJECT = re.compile(r"^[0-9a-f]+ .{6}O \.(?:bss|data|tm_clone)\S*\s+[0-9a-f]+\s+(?:\.hidden )?(?P<name>.*)$")
OWN = re.compile(r"^racebeam::(?:\(anonymous namespace\)::)?(?P<name>[\w:]+)")


def writable(libraries):
    """Pairs of a source file's name and an object of ours in writable memory."""
    file = None
    listing = subprocess.run(
        ["objdump", "--syms", "--demangle", *libraries], check=True, capture_output=True, text=True
    )
    for line in listing.stdout.splitlines():
        if found := MEMBER.match(line):
            file = found["file"]
        elif (found := OBJECT.match(line)) and (own := OWN.match(found["name"])) and ".data.rel.ro" not in line:
            yield file, own["name"]


@pytest.mark.skipif(not all(path.exists() for path in LIBRARIES), reason="the libraries were not built")
@pytest.mark.skipif(
    re.search(r"RACEBEAM_UNITY:BOOL=ON|-fsanitize|CMAKE_CXX_COMPILER:\w+=.*clang", CACHE) is not None,
    reason="sanitizers add objects, other compilers have other names for them, and a unity build joins them",
)
class TestShared:
    def test_what_is_shared_is_listed(self):
        shared = {pathlib.Path(file).stem for file, name in writable(LIBRARIES) if name.split("(")[0] not in CONSTANTS}
        section = LISTED.read_text().split("## What is shared")[1].split("\n## ")[0]
        names = {pathlib.Path(path).stem for path in re.findall(r"`(\w+/[\w/]+\.[hc]pp)`", section)}
        assert shared == names
