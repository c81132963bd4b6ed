"""With RACEBEAM_PROGRAM=OFF, the library for C++ and `golden` are built without Boost, OpenSSL and other libraries."""

import os
import pathlib
import re
import subprocess
import sys
import unittest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(sys.argv.pop())  # is kept, so that the next run compiles only what has changed
ABSENT = ("Boost", "OpenSSL", "PNG", "spdlog", "nlohmann_json", "Catch2")


def run(*command):
    """What a command prints. The test fails if the command does."""
    done = subprocess.run(list(map(str, command)), text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    if done.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, command))}\n{done.stdout}")
    return done.stdout


class WithoutProgram(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        absent = (f"-DCMAKE_DISABLE_FIND_PACKAGE_{name}=ON" for name in ABSENT)
        compiler = f"-DCMAKE_CXX_COMPILER={os.environ.get('CXX', 'c++')}"
        run("cmake", "-S", SOURCE, "-B", BUILD, "-G", "Ninja", compiler, "-DCMAKE_BUILD_TYPE=Debug",
            "-DRACEBEAM_PROGRAM=OFF", "-DRACEBEAM_UNITY=ON", *absent)  # fmt: skip
        run("cmake", "--build", BUILD, "--target", "golden", "racebeam_static")

    def test_golden_shows_what_it_showed(self):
        run(BUILD / "tests/golden/golden", "updraft")

    def test_golden_needs_no_library_but_those_of_the_compiler_and_zlib(self):
        table = run("readelf", "--dynamic", "--wide", BUILD / "tests/golden/golden")
        needed = set(re.findall(r"NEEDED.*\[(\w+)", table))
        self.assertEqual(needed - {"libstdc", "libm", "libgcc_s", "libc", "ld", "libpthread"}, {"libz"})

    def test_the_program_is_not_a_target(self):
        self.assertNotIn("\nracebeam:", run("cmake", "--build", BUILD, "--target", "help"))

    def test_what_is_installed_plays(self):
        prefix = BUILD / "installed"
        run("cmake", "--install", BUILD, "--prefix", prefix, "--component", "development")
        absent = "-DCMAKE_DISABLE_FIND_PACKAGE_OpenSSL=ON"
        consumer = BUILD / "consumer"
        (consumer / "project").mkdir(parents=True, exist_ok=True)
        (consumer / "project/CMakeLists.txt").write_text(
            "cmake_minimum_required(VERSION 3.25)\nproject(consumer LANGUAGES CXX)\n"
            "find_package(racebeam REQUIRED)\n"
            f"add_executable(in_process {SOURCE}/tests/clients/consumer/in_process.cpp)\n"
            "target_link_libraries(in_process PRIVATE racebeam::racebeam)\n"
        )
        run("cmake", "-S", consumer / "project", "-B", consumer / "built", f"-DCMAKE_PREFIX_PATH={prefix}", absent)
        run("cmake", "--build", consumer / "built")
        self.assertRegex(run(consumer / "built/in_process"), r"^[\d.]+ 82 400\n$")  # protocol/PROTOCOL.md, "States"


if __name__ == "__main__":
    unittest.main()
