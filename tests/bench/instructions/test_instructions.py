"""scripts/instructions: higher counts fail, lower ones are reported, and counts of other builds are
skipped."""

import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import callgrind
import pytest

SOURCE = pathlib.Path(__file__).resolve().parents[3]
TOOL = SOURCE / "scripts/instructions"
BINARY = os.environ.get("RACEBEAM_BINARY", str(SOURCE / "build/release/racebeam"))
SKIPPED = 77

CALLGRIND = """\
positions: line
events: Ir
summary: 47

ob=(1) /somewhere/racebeam
fl=(1) {root}/emulator/tia/tia.cpp
fn=(1) draw
10 7
+2 3
fi=(2) /usr/include/c++/12/array
* 5
fe=(1)
12 1
cob=(2) ???
cfi=(3) ???
cfn=(2) 0x0000000000abc000
calls=3 0
12 1000
fi=(4) {root}/emulator/tia/beam.hpp
30 2
ob=(2)
fl=(3)
fn=(2)
0 20
ob=(3) /lib/libc.so.6
fl=(5) ./string/memset.S
fn=(3) memset
5 9
"""


class TestReading:
    @pytest.fixture(autouse=True)
    def set_up(self, cleanup):
        with tempfile.NamedTemporaryFile("w", delete=False) as file:
            file.write(CALLGRIND.format(root=SOURCE))
        cleanup(os.unlink, file.name)
        self.counts = callgrind.read(pathlib.Path(file.name))

    def test_what_callees_cost_counts_once(self):
        assert self.counts.total == 47
        assert self.counts.functions == {"draw": 18, callgrind.MADE_AT_RUN_TIME: 20, "memset": 9}

    def test_what_is_inlined_counts_for_its_file_and_the_standard_library_for_its_user(self):
        assert self.counts.files == {
            "emulator/tia/tia.cpp": 16,
            "emulator/tia/beam.hpp": 2,
            callgrind.MADE_AT_RUN_TIME: 20,
            "libc.so.6 (not in the tree)": 9,
        }


@pytest.mark.skipif(not callgrind.available(), reason="valgrind is missing; scripts/setup installs it")
class TestChecking:
    @pytest.fixture(scope="class", autouse=True)
    @classmethod
    def set_up_class(cls, tmp_path_factory):
        cls.path = tmp_path_factory.mktemp("checking") / "baseline.json"
        done = cls.run_tool("--rebaseline")
        if done.returncode == SKIPPED:
            pytest.skip(done.stdout.strip())
        cls.baseline = json.loads(cls.path.read_text())

    @classmethod
    def run_tool(cls, *words, **environment):
        return subprocess.run(
            [sys.executable, "-B", TOOL, "--games", "ours", "--binary", BINARY, "--baseline", cls.path, *words],
            capture_output=True,
            text=True,
            env=os.environ | environment,
        )

    def check_against(self, change, **environment):
        edited = json.loads(json.dumps(self.baseline))
        change(edited)
        self.path.write_text(json.dumps(edited))
        return self.run_tool(**environment)

    def scaled(self, factor):
        def change(baseline):
            baseline["translator"]["beamfall"] = round(baseline["translator"]["beamfall"] * factor)

        return self.check_against(change)

    def test_a_second_count_is_the_same(self):
        done = self.scaled(1)
        assert done.returncode == 0, done.stdout + done.stderr
        assert done.stdout.count("+0.0%") == 2, done.stdout

    def test_five_percent_more_is_a_failure(self):
        done = self.scaled(1 / 1.06)
        assert done.returncode == 1, done.stdout
        assert re.search(r"beamfall .* \+6\.0%  DEARER", done.stdout)
        assert "--rebaseline" in done.stdout

    def test_less_than_that_is_not(self):
        assert self.scaled(1 / 1.04).returncode == 0

    def test_five_percent_less_is_reported(self):
        done = self.scaled(1 / 0.94)
        assert done.returncode == 0
        assert re.search(r"beamfall .* -6\.0%  cheaper", done.stdout)

    def test_a_game_that_the_baseline_lacks_is_a_failure(self):
        done = self.check_against(lambda baseline: baseline["translator"].pop("updraft"))
        assert done.returncode == 1
        assert "NOT IN THE BASELINE" in done.stdout

    def test_another_compiler_or_no_valgrind_is_skipped_and_says_so(self):
        other = self.check_against(lambda baseline: baseline.update(build="g++ 2.95 Release"))
        without = self.check_against(lambda baseline: None, PATH="/nowhere")
        for done, reason in ((other, "counted with 'g++ 2.95 Release'"), (without, "valgrind is missing")):
            assert done.returncode == SKIPPED, done.stdout + done.stderr
            assert reason in done.stdout
