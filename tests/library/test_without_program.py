"""With RACEBEAM_PROGRAM=OFF, library and Python module are built without Boost, OpenSSL and others, and play.

The module is left out where `scripts/wheel --venv` has not installed what it needs.
"""

import os
import pathlib
import re
import shutil

import pytest

SOURCE = pathlib.Path(__file__).resolve().parents[2]

from commands import output_of as run

BUILD = SOURCE / "build/release/without_program"  # is kept, so that the next run compiles only what has changed
ABSENT = ("Boost", "OpenSSL", "PNG", "spdlog", "nlohmann_json", "Catch2")
PYTHON = SOURCE / "build/python"
PLAY = """
import racebeam
game = racebeam.ALEInterface()
game.setInt("random_seed", 7)
game.setInt("frame_skip", 4)
game.setFloat("repeat_action_probability", 0)
game.loadROM("builtin:beamfall")
print(sum(game.act(racebeam.Action.FIRE) for _ in range(100)), game.getEpisodeFrameNumber())
try:
    racebeam.launch()
except FileNotFoundError as error:
    print(error)
"""
SCORE = "82 400"  # protocol/PROTOCOL.md, "States"


@pytest.mark.slow
class TestWithoutProgram:
    @pytest.fixture(scope="class", autouse=True)
    @classmethod
    def set_up_class(cls):
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
        assert needed - {"libstdc", "libm", "libgcc_s", "libc", "ld", "libpthread"} == {"libz"}

    def test_the_server_is_not_a_target(self):
        assert "\nracebeam_server:" not in run("cmake", "--build", BUILD, "--target", "help")

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
        assert re.search(rf"^[\d.]+ {SCORE}\n$", run(consumer / "built/in_process"))

    def test_the_python_module_plays_and_launch_says_what_to_install(self):
        builder, player = (PYTHON / folder / "bin/python" for folder in ("tools", "venv"))
        if not (builder.exists() and player.exists()):
            pytest.skip("no environments of scripts/wheel --venv")
        absent = (f"--config-settings=cmake.define.CMAKE_DISABLE_FIND_PACKAGE_{name}=ON" for name in ABSENT)
        package = BUILD / "package"
        shutil.rmtree(package, ignore_errors=True)
        run(builder, "-m", "pip", "install", "--quiet", "--no-build-isolation", "--no-deps", "--no-index",
            "--target", package, "--config-settings=cmake.define.RACEBEAM_PROGRAM=OFF", *absent,
            "--config-settings=cmake.build-type=Debug", f"--config-settings=build-dir={BUILD}/python",
            SOURCE)  # fmt: skip
        assert [file for file in package.rglob("racebeam") if file.is_file()] == []
        plain = {key: value for key, value in os.environ.items() if key != "RACEBEAM_PROGRAM"}
        score, sentence = run(player, "-B", "-c", PLAY, env={**plain, "PYTHONPATH": package, "PATH": ""}).splitlines()
        assert score == SCORE
        assert re.search("the program racebeam is neither .*; install a wheel that has it", sentence)
