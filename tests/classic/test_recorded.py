"""`racebeam classic` gives the recorded output of ALE 0.6.0, in one session of each of its games."""

import os
from concurrent.futures import ThreadPoolExecutor

import pytest
from images import folder, image, images
from recorded import digest, read
from session import BINARY, play

RUNS = [(run, expected) for run, expected in read() if run.game in images()]


@pytest.mark.skipif(not RUNS, reason=f"no cartridge images are in {folder()}")
class TestKept:
    def test_sessions_are_those_of_ale_0_6(self, subtests):
        with ThreadPoolExecutor(os.cpu_count()) as pool:
            answers = pool.map(lambda recorded: play([BINARY, "classic"], recorded[0], image(recorded[0].game)), RUNS)
            for (run, expected), answer in zip(RUNS, answers):
                with subtests.test(run=run.name):
                    assert digest(answer) == expected, answer.errors
