"""scripts/bench core: sides that do the same are measured, a difference fails, and the page gets its tables."""

import glob
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import bench_picture
import bench_report
import bench_settings
import page_part
import pytest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
BINARY = os.environ.get("RACEBEAM_BINARY", str(SOURCE / "build/release/racebeam"))

# A racebeam whose answer to the third command of a kind has one bit wrong in a field.
LIAR = """\
#!{python}
import json, subprocess, sys
real = subprocess.Popen([{binary!r}, *sys.argv[1:]], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
count = 0
for line in sys.stdin:
    print(line, end="", file=real.stdin, flush=True)
    answer = json.loads(real.stdout.readline())
    count += line.startswith({command!r})
    if count == 3 and {field!r} in answer:
        answer[{field!r}] ^= 1
    print(json.dumps(answer), flush=True)
"""


def python_with_reference():
    for python in (sys.executable, *glob.glob(str(SOURCE / ".venv/bin/python"))):
        if subprocess.run([python, "-c", "import ale_py, numpy"], capture_output=True).returncode == 0:
            return python
    return None


PYTHON = python_with_reference()


def figures(ratio):
    setting = {"ale_frames_per_second": 100, "racebeam_frames_per_second": 100 * ratio, "ratio": ratio}
    return {name: setting for name in bench_settings.SETTINGS}


def results(ratios):
    return {
        "command": "scripts/bench core",
        "date": "2026-01-02",
        "seconds": 60,
        "frames": 500,
        "chunk_frames": 500,
        "differences": [],
        "machine": {"processor": "P", "processors": 2, "system": "S"},
        "versions": {"racebeam": "1", "commit": "c", "compiler": "g", "ale_py": "0", "python": "3"},
        "games": {game: figures(ratio) for game, ratio in ratios.items()},
    }


class TestReports:
    def test_the_summary_has_the_geomean_and_the_worst(self):
        for mean, worst, game in bench_report.summary(results({"one": 2, "other": 8})).values():
            assert mean == pytest.approx(4, rel=0, abs=0.5e-7)
            assert (worst, game) == (2, "one")

    def test_the_picture_has_a_bar_a_game_the_shortest_first(self):
        picture = bench_picture.draw({"fast": 9.5, "slow": 3.25, "middle": 5}, "Heading")
        places = [picture.index(f">{words}<") for words in ("slow", "3.25", "middle", "5.00", "fast", "9.50")]
        assert places == sorted(places)
        assert ">10x<" in picture
        assert "worst 3.25 (slow)" in picture

    def test_the_summary_goes_between_the_markers_of_the_page_and_the_games_into_a_file(self):
        with tempfile.TemporaryDirectory() as folder:
            bench_report.PAGE = pathlib.Path(folder) / "page.md"
            bench_report.FIGURES = pathlib.Path(folder) / "figures/figures.md"
            bench_report.PICTURE = pathlib.Path(folder) / "figures/picture.svg"
            bench_report.SUMMARY = pathlib.Path(folder) / "figures/summary.svg"
            bench_report.PAGE.write_text(f"before\n{page_part.begin(bench_report.SCRIPT)}old\n{page_part.END}\nafter\n")
            bench_report.write(results({"one": 2}))
            page = bench_report.PAGE.read_text()
            assert re.search(r"(?s)^before\n.*\(figures/picture\.svg\).*\| 2\.00 \| 2\.00 \| one \|.*\nafter\n$", page)
            assert "| one | 100" not in page
            assert "| one | 100 | 200 | 2.00 |" in bench_report.FIGURES.read_text()
            assert "old" not in page
            assert bench_report.PICTURE.exists()
            assert "means of 1 games" in bench_report.SUMMARY.read_text()
            bench_report.PAGE.write_text("a page without markers")
            with pytest.raises(OSError, match="lacks the lines"):
                bench_report.write(results({"one": 2}))
            assert bench_report.PAGE.read_text() == "a page without markers"


class TestActions:
    def test_a_game_gets_the_same_actions_each_time_and_others_get_others(self):
        def draw(game):
            return bench_settings.draw_actions(game, range(18), 1000)

        assert draw("pong") == draw("pong")
        assert draw("pong") != draw("qbert")
        assert set(draw("pong")) == set(range(18))


@pytest.mark.skipif(PYTHON is None, reason="ale-py is missing here and in .venv (scripts/reference installs it)")
class TestMeasuring:
    def measure(self, binary, *words):
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder) / "core.json"
            done = subprocess.run(
                [
                    PYTHON,
                    "-B",
                    SOURCE / "scripts/measure/bench_core.py",
                    "--games",
                    "pong",
                    "--frames",
                    "1000",
                    "--out",
                    out,
                    *words,
                ],
                capture_output=True,
                text=True,
                env=os.environ | {"RACEBEAM_BINARY": str(binary)},
            )
            return done, json.loads(out.read_text()) if out.exists() else None

    def measure_liar(self, command, field, *words):
        with tempfile.TemporaryDirectory() as folder:
            liar = pathlib.Path(folder) / "racebeam"
            liar.write_text(LIAR.format(python=sys.executable, binary=BINARY, command=command, field=field))
            liar.chmod(0o755)
            return self.measure(liar, *words)[0]

    def test_every_setting_is_measured(self):
        done, found = self.measure(BINARY)
        assert done.returncode == 0, done.stderr
        game = found["games"]["pong"]
        assert list(game) == ["every", "last", "none", "states"]
        for name in bench_settings.SETTINGS:
            assert [frames for _, _, frames in game[name]["chunks"]] == [500, 500]
            assert game[name]["ratio"] > 0
        assert all(value > 0 for value in game["states"].values())

    @pytest.mark.parametrize(
        "command, field, setting",
        (
            ("play", "screen", "every"),
            ("play", "ram", "none"),
            ("check", "digest", "last"),
            ("play", "reward", "none"),
            ("reset", "screen", "states"),
        ),
    )
    def test_a_difference_makes_the_run_fail_and_is_named(self, command, field, setting):
        done = self.measure_liar(command, field, "--settings", setting)
        assert done.returncode == 1, done.stderr
        assert re.search(rf"bench: pong differs from the reference in setting {setting}, .*: {field} ", done.stderr)

    def test_a_game_without_an_image_is_named(self):
        done, _ = self.measure(BINARY, "--games", "pang")
        assert done.returncode == 1
        assert "no image of pang was found in" in done.stderr
