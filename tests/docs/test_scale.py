"""What docs/scale.md says of the paper's experiment is what the program and cluster/simulate.py print."""

import os
import re
import subprocess
import sys

from tree import ROOT

BINARY = os.environ.get("RACEBEAM_BINARY", str(ROOT / "build/release/racebeam"))
TEXT = (ROOT / "docs/scale.md").read_text()
PAPER = " ".join(TEXT.partition("## The paper in a day\n")[2].partition("### From a pilot")[0].split())
ROW = re.compile(r"^\| (none|`--.*?`).* \| (not possible|[\d,]+) \| (-|[\d,]+) \| (?:-|(\d+) %) \|$", re.MULTILINE)


def number(text):
    return int(text.replace(",", ""))


def simulate(*words):
    """The last row that cluster/simulate.py prints, as words. None: no number of nodes is enough."""
    done = subprocess.run(
        [sys.executable, ROOT / "cluster/simulate.py", "paper", "--program", BINARY, *words],
        capture_output=True,
        text=True,
    )
    if done.stderr.startswith("no number of nodes is enough"):
        return None
    assert done.returncode == 0, done.stderr
    return done.stdout.splitlines()[-1].split()


class TestMemory:
    def test_the_prose_has_the_largest_session_of_one_game_of_the_table(self):
        table = TEXT.partition("<!-- scripts/check/memory --write: begin -->")[2].partition("<!-- end -->")[0]
        rows = re.findall(r"^\| (\S.*?) \| ([\d,]+) \| ([\d,]+) \|", table, re.MULTILINE)
        assert len(rows) == 7
        largest = max(number(resident) for name, _, resident in rows if "open" not in name)
        rounded = -(-largest // 10) * 10
        for page in (TEXT, (ROOT / "server/README.md").read_text()):
            assert f"A session of one game takes up to {rounded} KiB" in " ".join(page.split())
        assert f"10,000 acting sessions take up to {rounded / 100:.1f} GB" in " ".join(TEXT.split())

    def test_counted_and_resident_memory_differ_by_less_than_the_factor_of_the_check(self):
        table = TEXT.partition("<!-- scripts/check/memory --write: begin -->")[2].partition("<!-- end -->")[0]
        for counted, resident in re.findall(r"\| ([\d,]+) \| ([\d,]+) \| [\d,]+ \| [\d,]+ \|$", table, re.MULTILINE):
            assert 1 / 1.5 <= number(counted) / number(resident) <= 1.5, (counted, resident)


class TestPaper:
    def claim(self, pattern):
        found = re.search(pattern, PAPER)
        assert found is not None, f"docs/scale.md has no longer: {pattern}"
        return found

    def test_the_units_and_their_hours_are_those_of_the_dry_run(self):
        output = subprocess.run(
            [BINARY, "experiment", "paper", "--dry-run", "--unmeasured"], check=True, capture_output=True, text=True
        ).stdout
        found = {
            name: (int(units), float(hours))
            for name, units, hours in re.findall(r"^(\w+) +(\d+) units .* ([\d.]+) core-hours$", output, re.MULTILINE)
        }
        units, hours = found["all"]
        claim = self.claim(r"counts ([\d,]+) units and ([\d,]+) core-hours")
        assert (number(claim[1]), number(claim[2])) == (units, round(hours))
        assert number(self.claim(r"24 hours of ([\d,]+) cores")[1]) == -(-hours // 24)
        longest = found["ram"][1] / found["ram"][0]
        claim = self.claim(r"the agent `ram` takes ([\d.]+) hours, and ([\d.]+) on a straggler")
        assert (claim[1], claim[2]) == (f"{longest:.1f}", f"{2 * longest:.1f}")

    def test_the_nodes_are_those_of_the_simulation(self, subtests):
        table = TEXT.partition("## The paper in a day\n")[2].partition("### From a pilot")[0]
        rows = ROW.findall(table)
        assert len(rows) == 5
        for options, nodes, cores, busy in rows:
            with subtests.test(options=options):
                found = simulate("--within", "24", *(options.strip("`").split() if options != "none" else []))
                if found is None:
                    assert (nodes, cores) == ("not possible", "-")
                else:
                    assert (number(nodes), number(cores), f"{busy}%") == (int(found[0]), int(found[1]), found[4])

    def test_what_failures_cost_is_what_the_simulation_says(self):
        claim = self.claim(
            r"With `--failures 365`, when each node fails once a day, (\d+) nodes take ([\d.]+) hours, and repeat "
            r"(\d+) core-hours. "
            r"With one checkpoint an hour \(`--checkpoint 3600`\), they take ([\d.]+) hours and repeat (\d+) core-hours"
        )
        for words, hours, waste in (((), claim[2], claim[3]), (("--checkpoint", "3600"), claim[4], claim[5])):
            found = simulate("--longest-first", "--failures", "365", "--nodes", claim[1], *words)
            assert (hours, int(waste)) == (found[2], round(float(found[5])))
