"""scripts/load --soak: what it calls a growth, and that it runs."""

import csv
import os
import subprocess
import xml.etree.ElementTree

import bench_picture
import cartridges
import hostile
import pytest
import soak

FLAT = {"rest_resident": 100.0, "rest_files": 40, "threads": 7, "p99": 10.0, "health_p99": 20.0}


def rows(**growing):
    """A hundred intervals of a minute. growing: what a figure has at the end, times its first value."""
    return [
        {"seconds": 60 * n, **{name: value * (1 + (growing.get(name, 1) - 1) * n / 99) for name, value in FLAT.items()}}
        for n in range(100)
    ]


class TestPercentile:
    @pytest.mark.parametrize(
        "waits, share, by_hand",
        [
            ([40, 15, 50, 20, 35], 0.3, 20),  # 1.5 waits: the second one
            ([40, 15, 50, 20, 35], 0.4, 20),
            ([40, 15, 50, 20, 35], 0.5, 35),
            ([40, 15, 50, 20, 35], 1, 50),
            (range(1, 11), 0.99, 10),
            (range(1, 101), 0.99, 99),
            (range(1, 102), 0.99, 100),
            (range(1, 101), 0.07, 7),
            ([9, 8], 0.5, 8),
            ([9, 8], 0, 8),
        ],
    )
    def test_it_is_the_nearest_rank(self, waits, share, by_hand):
        assert hostile.percentile(waits, share) == by_hand


class TestVerdict:
    def test_flat_figures_pass(self, capsys):
        assert soak.judge(rows())
        assert "EXCEEDED" not in capsys.readouterr().out

    def test_each_figure_that_grows_fails(self, capsys, subtests):
        for name in FLAT:
            with subtests.test(figure=name):
                assert not soak.judge(rows(**{name: 4}))
                lines = [line for line in capsys.readouterr().out.splitlines() if "EXCEEDED" in line]
                assert [line.startswith(soak.FIGURES[name][0]) for line in lines] == [True]

    def test_the_first_tenth_does_not_count(self):
        course = rows()
        for row in course[:10]:
            row["rest_resident"] = 1.0
        first, last, *_ = soak.compare(course)["rest_resident"]
        assert (first, last) == (100, 100)

    def test_the_growth_is_that_of_an_hour(self):
        growth = soak.compare(rows(rest_resident=2))["rest_resident"][3]
        assert abs(growth - 100 / (99 / 60)) < 1e-6

    def test_one_interval_is_enough(self):
        assert soak.judge(rows()[:1])


class TestPicture:
    def test_a_panel_for_each_figure(self):
        picture = bench_picture.draw_course([0.5, 1.0, 1.5], [{"a": 1, "b": 0}] * 3, {"a": "One", "b": "Other"})
        texts = [element.text for element in xml.etree.ElementTree.fromstring(picture).iter() if element.text]
        assert [text for text in texts if "at most" in text] == ["One: at most 1", "Other: at most 0"]
        assert picture.count("<polyline") == 2


class TestRun:
    def test_a_server_is_loaded_and_ends(self, tmp_path):
        build = os.path.dirname(os.environ["RACEBEAM_BINARY"])
        done = subprocess.run(
            [
                cartridges.ROOT / "scripts/load",
                "--soak",
                "0.0015",
                "--interval",
                "2",
                "--build",
                build,
                "--into",
                tmp_path,
            ],
            capture_output=True,
            text=True,
            timeout=300,
        )
        assert "the server ended with status 0" in done.stdout, done.stdout + done.stderr
        with open(tmp_path / "soak.csv", newline="") as file:
            table = list(csv.DictReader(file))
        assert table
        assert all(int(row["acts"]) > 0 and float(row["resident"]) > 1 for row in table)
        assert (tmp_path / "soak.svg").read_text().startswith("<svg")
