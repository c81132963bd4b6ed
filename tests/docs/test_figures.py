"""The speeds in README.md are those of the last run of scripts/bench core, which docs/performance.md has."""

import re

import bench_picture
import pytest
from tree import ROOT

SETTINGS = ("Screen of every frame", "Frame skip 4, screen of the last", "Rewards and RAM only")


def last_run():
    """Returns the geometric mean of each setting, the number of games, and the processor's name."""
    text = (ROOT / "docs/performance.md").read_text()
    block = text.partition("<!-- scripts/bench core --write: begin -->")[2].partition("<!-- end -->")[0]
    means = {
        name: float(mean)
        for name, mean in re.findall(r"^\| ([^|]+) \| ([\d.]+) \| [\d.]+ \| \w+ \|$", block, re.MULTILINE)
    }
    games = int(re.search(r"^\| games \| (\d+),", block, re.MULTILINE)[1])
    processor = re.search(r"^\| processor \| (.*), \d+ processors \|$", block, re.MULTILINE)[1]
    return {name: means[name] for name in SETTINGS}, games, processor


class TestReadme:
    @pytest.fixture(autouse=True)
    def set_up(self):
        self.means, self.games, self.processor = last_run()

    def test_the_speeds_of_the_readme_are_those_of_the_last_run(self):
        text = " ".join((ROOT / "README.md").read_text().split())
        every, last, none = (f"{mean:.1f}" for mean in self.means.values())
        assert (
            f"runs {every} times as many frames a second as ALE with the screen of every frame, "
            f"{last} times as many with frame skip 4, and {none} times as many with rewards and RAM only. "
            f"These are means of {self.games} games on an {self.processor};"
        ) in text

    def test_the_chart_of_the_readme_is_that_of_the_last_run(self):
        assert (ROOT / "docs/performance/summary.svg").read_text() == bench_picture.draw_summary(self.means, self.games)
