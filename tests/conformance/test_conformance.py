"""The suite itself: it must find and locate differences, reproduce them, and never count what it did not
compare."""

import pathlib
import re
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import pytest  # isort: skip
import reference_python  # isort: skip

pytest.importorskip("ale_py")
pytest.importorskip("numpy")
reference_python.zero_new_memory()

import json
import os
import shlex
import signal
import struct
import subprocess
import tempfile
import time
import zlib

import images
import not_comparable
import ours
import plan
import pool
import programs
from run import Run

FOLDER = pathlib.Path(__file__).resolve().parent
GAME = "pong"
# its screen depends on memory at power-on
FREEWAY = ("--games", "freeway", "--racebeam-options=--system-seed 1")


pytestmark = pytest.mark.needs_roms(GAME)


class Suite:
    @pytest.fixture(autouse=True)
    def set_up(self, cleanup):
        self.temporary = tempfile.TemporaryDirectory()
        cleanup(self.temporary.cleanup)
        self.out = pathlib.Path(self.temporary.name)

    def command(self, *words):
        return [sys.executable, "-B", str(FOLDER), "--out", str(self.out), *words]

    def suite(self, *words, binary=None):
        environment = {**os.environ, **({"RACEBEAM_BINARY": str(binary)} if binary else {})}
        done = subprocess.run(self.command(*words), capture_output=True, text=True, env=environment, timeout=250)
        return done.returncode, done.stdout + done.stderr

    def short(self, *words, **more):
        return self.suite(
            "--games", GAME, "--settings", "default", "--seeds", "1", "--frames", "60", "--seed", "3", *words, **more
        )

    def result_lines(self):
        """The complete lines of the results."""
        return [json.loads(line) for line in (self.out / "results.jsonl").read_text().split("\n")[:-1]]


class TestVerdicts(Suite):
    def test_a_game_that_is_the_same(self):
        status, output = self.short()
        assert status == 0, output
        assert "1 of 1 runs identical, 60 frames" in output
        assert list(self.out.glob("*.png")) == []
        assert f"| {GAME} | 60 | 0 | 0 | identical |" in (self.out / "conformance.md").read_text()

    def test_another_power_on_is_found_and_shown(self):
        status, output = self.short(*FREEWAY)
        assert status == 1, output
        assert re.search(r"first difference in line \d+, frame \d+, act \d+ of episode 1", output)
        assert re.search(r"ram +reference [0-9a-f]{8}  racebeam [0-9a-f]{8}", output)
        assert re.search(r"ram\[[89A-F][0-9A-F]\] +reference [0-9a-f]{2}  racebeam [0-9a-f]{2}", output)
        assert "0 of 1 runs identical" in output
        assert "1 of 1 runs are not identical" in (self.out / "conformance.md").read_text()

    def test_the_commands_that_it_prints_show_the_difference_again(self):
        _, output = self.short(*FREEWAY)
        again = next(line for line in output.splitlines() if "again:" in line).split("scripts/conformance ")[1]
        rerun = subprocess.run([*self.command(), *shlex.split(again)], capture_output=True, text=True, timeout=250)
        assert rerun.returncode == 1, rerun.stdout + rerun.stderr
        assert differences(output) == differences(rerun.stdout)
        trace = next(line for line in output.splitlines() if "racebeam: " in line and " trace " in line)
        traced = subprocess.run(trace.split("racebeam: ")[1], shell=True, capture_output=True, text=True, timeout=250)
        assert traced.returncode == 0, traced.stderr
        assert re.search(r"(?m)^S \d+ [0-9a-f]+ [0-9a-f]+$", traced.stdout)

    def test_a_perturbed_rule_is_found_in_the_fields_that_it_changes(self):
        text = (ours.SOURCE / "games/catalogue" / f"{GAME}.toml").read_text()
        assert 'lives = "0"' in text
        rule = self.out / f"{GAME}.toml"
        rule.write_text(text.replace('lives = "0"', 'lives = "7"'))
        status, output = self.short(f"--racebeam-options=--game-file {rule}")
        assert status == 1, output
        assert differences(output) == ["  lives         reference 0  racebeam 7"]

    def test_pictures_that_differ_are_drawn_beside_each_other(self):
        status, output = self.short("--racebeam-options=--color-averaging")
        assert status == 1, output
        (picture,) = self.out.glob("*.png")
        width, height, pixels = read_png(picture)
        assert (width, height) == (3 * 320 + 2 * 8, 210)
        columns = [[row[3 * x : 3 * x + 3] for x in range(0, 320, 2)] for row in pixels]
        other = [[row[3 * x : 3 * x + 3] for x in range(328, 648, 2)] for row in pixels]
        marked = [[row[3 * x : 3 * x + 3] == b"\xff\0\xff" for x in range(656, 976, 2)] for row in pixels]
        assert any(map(any, marked))
        for left, right, marks in zip(columns, other, marked):
            for a, b, mark in zip(left, right, marks):
                assert (a != b) == mark

    def test_all_forms_of_the_machine_are_compared(self):
        status, output = self.short("--forms")
        assert status == 0, output
        assert "interpreter, translator, plain |" in (self.out / "conformance.md").read_text()

    def test_a_form_that_differs_is_found(self):
        for form, condition in (
            ("interpreter", "case $* in *interpreter*)"),
            ("plain", "case $RACEBEAM_SIMD in plain)"),
        ):
            other = self.out / "racebeam"
            other.write_text(
                f'#!/bin/sh\n{condition} {ours.BINARY} "$@" | sed \'9s/.$/x/\';; *) exec {ours.BINARY} "$@";; esac\n'
            )
            other.chmod(0o755)
            status, output = self.short("--forms", binary=other)
            assert status == 1, output
            assert f"{form}, line 8: " in output
            other.unlink()

    def test_a_racebeam_that_does_not_run_is_a_difference(self):
        broken = self.out / "racebeam"
        broken.write_text(
            f'#!/bin/sh\ncase $1 in trace) echo "racebeam: no" >&2; exit 1;; esac\nexec {ours.BINARY} "$@"\n'
        )
        broken.chmod(0o755)
        status, output = self.short(binary=broken)
        assert status == 1, output
        assert "racebeam ended with status 1: racebeam: no" in output

    def test_lines_that_are_missing_are_a_difference(self):
        short = self.out / "racebeam"
        short.write_text(
            f'#!/bin/bash\n[[ $1 == trace ]] || exec {ours.BINARY} "$@"\n{ours.BINARY} "$@" | head -n 20\n'
        )
        short.chmod(0o755)
        status, output = self.short(binary=short)
        assert status == 1, output
        assert "racebeam ended with fewer lines" in output

    def test_machines_without_a_rule_are_compared_too(self):
        for game in images.WITHOUT_RULE:
            status, output = self.suite("--games", game, "--settings", "default", "--seeds", "1", "--frames", "200")
            assert status == 0, output


class TestPrograms(Suite):
    def programs(self, *words, **more):
        return self.suite("--programs", "--minutes", "0.02", "--jobs", "1", "--seed", "7", *words, **more)

    def test_programs_that_run_the_same(self):
        status, output = self.programs()
        assert status == 0, output
        assert re.search(r"[1-9]\d* random programs from seed 7, [1-9][\d,]* frames, .* minutes: 0 differ", output)

    def test_a_program_that_runs_differently_is_found_and_shown_again(self):
        status, output = self.programs("--racebeam-options=--system-seed 1")
        assert status == 1, output
        assert re.search(r"random_program:.*seed=7.*: DIFFERENT: first difference in line 0", output)
        again = next(line for line in output.splitlines() if "again:" in line).split("scripts/conformance ")[1]
        rerun = subprocess.run([*self.command(), *shlex.split(again)], capture_output=True, text=True, timeout=250)
        assert rerun.returncode == 1, rerun.stdout + rerun.stderr

    def test_the_seed_determines_an_image(self):
        for kind in programs.KINDS:
            one, same, other = (programs.image_of(kind, seed) for seed in (1, 1, 2))
            assert one == same
            assert one != other


class TestKeeping(Suite):
    def test_resuming_plays_only_what_is_missing(self):
        self.short("--seeds", "2")
        path = self.out / "results.jsonl"
        path.write_text(path.read_text()[:-30])  # interrupted while it wrote
        status, output = self.suite(
            "--games", GAME, "--settings", "default", "--seeds", "2", "--frames", "60", "--resume"
        )
        assert status == 0, output
        assert "1 runs are done already" in output
        assert "2 of 2 runs identical" in output
        assert len(self.result_lines()) == 3  # with the header

    def test_results_of_another_program_are_not_taken_up(self):
        self.short()
        status, output = self.short("--resume", "--racebeam-options=--system-seed 1")
        assert status == 2
        assert "can't resume" in output

    @pytest.mark.parametrize("number", (signal.SIGINT, signal.SIGTERM))
    def test_an_interrupt_leaves_what_was_done(self, number):
        self.interrupt(number)

    def interrupt(self, number):
        (self.out / "results.jsonl").unlink(missing_ok=True)
        suite = subprocess.Popen(
            self.command("--frames", "300", "--settings", "all", "--games", GAME, "--jobs", "1"),
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            start_new_session=True,
        )
        deadline = time.monotonic() + 60
        while time.monotonic() < deadline and not (
            (self.out / "results.jsonl").exists() and len(self.result_lines()) > 2
        ):
            time.sleep(0.05)
        os.kill(suite.pid, number)
        printed, _ = suite.communicate(timeout=60)
        assert suite.returncode == 130, printed
        assert "--resume" in printed
        assert "DIFFERENT" not in printed
        assert "Traceback" not in printed

    def test_bad_options_are_refused_with_a_sentence(self):
        for words, sentence in (
            (["--games", "pongg"], "no image of 'pongg' was found"),
            (["--run", "pong:skipp=2"], "'skipp' of the run"),
            (["--run", "pong:skip=x"], "'x' is not a value for skip"),
            (["--run", "pongg:seed=2"], "no image of 'pongg' was found"),
            (["--seed", "x"], "'x' is not a seed"),
            (["--frames", "0"], "--frames is 0"),
            (["--programs", "--minutes", "0"], "--minutes is 0.0; it must be more than 0"),
        ):
            status, output = self.suite(*words)
            assert status == 2, output
            assert sentence in output


class TestPlans:
    def test_every_setting_of_every_game_is_there(self):
        for game in images.games():
            runs, _ = plan.plan([game], "all", [1, 2], 20000, 2000)
            default = (None, None, 1, 0, 0)
            settings = [run.setting for run in runs if run.setting != default]
            assert [run.frames for run in runs if run.setting == default] == [20000, 20000]
            assert len(set(settings)) == len(settings)
            assert len(settings) == 8 * len(plan.variants(game)) - 1

    def test_a_run_is_found_again_by_its_name(self):
        runs, _ = plan.plan(images.games(), "all", [1, 2], 20000, 2000)
        for run in runs:
            assert Run.parse(run.name) == run
        assert len({run.name for run in runs}) == len(runs)

    def test_only_the_name_decides_what_is_played(self):
        one, same, other = (list(Run("pong", seed=seed, writes=1).steps()) for seed in (1, 1, 2))
        assert one == same
        assert one != other
        assert any(step[0] == "M" for step in one)

    def test_what_is_not_comparable_is_counted_and_the_rest_is_played(self):
        run = Run("video_cube", mode=4200, limit=254, writes=1)
        comparable, gaps = not_comparable.comparable(run)
        assert (comparable.limit, comparable.writes, comparable.mode, len(gaps)) == (0, 1, 4200, 1)


class TestPools:
    def test_a_piece_that_dies_or_hangs_takes_nothing_with_it(self):
        pieces = {"fine": lambda: "done" * 1, "dies": lambda: os._exit(3), "hangs": lambda: time.sleep(60)}
        results = dict(pool.results(lambda name: {"is": pieces[name]()}, list(pieces), 2, 5))
        assert results["fine"] == {"is": "done"}
        assert "status 3" in results["dies"]
        assert "not done after 5 seconds" in results["hangs"]


def differences(printed):
    """The fields that differ, as they were printed."""
    return [line for line in printed.splitlines() if " reference " in line and "  racebeam " in line]


def read_png(path):
    """Width, height, rows of a PNG of 8-bit RGB whose rows have no filter."""
    data = path.read_bytes()[8:]
    chunks = {}
    while data:
        length, kind = struct.unpack(">I4s", data[:8])
        chunks[kind] = data[8 : 8 + length]
        assert zlib.crc32(kind + chunks[kind]) == struct.unpack(">I", data[8 + length : 12 + length])[0]
        data = data[12 + length :]
    width, height = struct.unpack(">II", chunks[b"IHDR"][:8])
    raw = zlib.decompress(chunks[b"IDAT"])
    return width, height, [raw[y * (3 * width + 1) + 1 : (y + 1) * (3 * width + 1)] for y in range(height)]
