"""cluster/slurm/racebeam-srun with a stand-in for srun. scripts/cluster-test runs it on a real Slurm."""

import os
import re
import subprocess
import sys

import pytest
from harness import BINARY, PATIENCE, SOURCE

SCRIPT = os.path.join(SOURCE, "cluster", "slurm", "racebeam-srun")
CLIENT = os.path.join(SOURCE, "clients", "python", "single_file")
# Runs the words after the options in a step of a job.
SRUN = '#!/bin/bash\nwhile [[ $1 == --* ]]; do shift; done\nSLURM_STEP_ID=0 exec "$@"\n'
PLAY = f"""import os, sys
sys.path.insert(0, {CLIENT!r})
import client
with client.connect() as game:
    print(game.hello()["max_machines"], "machines")
    game.load("beamfall", seed=1)
    game.observe("screen:raw")
    screen = game.act("FIRE")["screen"]
    print(len(screen), open(os.environ["RACEBEAM_ADDRESS"].split(":", 1)[1].split("?")[0]).read())
sys.exit(int(sys.stdin.read()))
"""
WARNING = "if srun forwards standard output"


class TestSrun:
    @pytest.fixture(autouse=True)
    def set_up(self, tmp_path):
        self.place = tmp_path
        programs, self.folder = self.place / "programs", self.place / "jobs"
        programs.mkdir()
        self.folder.mkdir()
        (programs / "srun").write_text(SRUN)
        (programs / "srun").chmod(0o755)
        (programs / "racebeam").symlink_to(BINARY)
        self.environment = {name: value for name, value in os.environ.items() if not name.startswith("RACEBEAM_")}
        self.environment["PATH"] = f"{programs}:{os.environ['PATH']}"

    def run_script(self, *words, input="", **environment):
        done = subprocess.run(
            [SCRIPT, *words],
            input=input,
            capture_output=True,
            text=True,
            timeout=PATIENCE,
            cwd=self.folder,
            env=self.environment | environment,
        )
        assert os.listdir(self.folder) == [], "left in the working directory"
        return done.returncode, done.stdout, done.stderr

    def test_an_agent_gets_a_socket_and_the_script_its_status(self):
        status, output, errors = self.run_script(sys.executable, "-B", "-c", PLAY, input="7")
        assert status == 7
        assert WARNING not in errors
        assert re.search(r'\n33600 [\s\S]*"tcp://[\s\S]*token', output)

    def test_the_server_has_the_options_of_the_variable(self):
        words = (sys.executable, "-B", "-c", PLAY)
        output = self.run_script(*words, input="0", RACEBEAM_OPTIONS="--max-machines 3")
        assert (output[0], output[1].splitlines()[0]) == (0, "3 machines")

    def test_the_failure_of_a_server_ends_the_agent(self):
        status, _, errors = self.run_script("sleep", "1000", RACEBEAM_OPTIONS="--max-machines none")
        assert status == 2
        assert "--max-machines" in errors

    def test_streams_are_there_for_those_who_ask_and_the_server_warns(self):
        status, output, errors = self.run_script("serve", "--stdio", input="load beamfall seed=1\nact FIRE\n")
        assert status == 0
        assert output.splitlines()[1] == "ok reward=0 terminated=0 truncated=0 lives=4"
        assert WARNING in errors
        assert "racebeam-srun COMMAND" in errors

    def test_without_a_command_it_says_what_it_takes(self):
        assert self.run_script() == (
            2,
            "",
            "racebeam-srun: the command is missing; accepted: COMMAND [ARGUMENT...], serve --stdio [OPTION...]\n",
        )
