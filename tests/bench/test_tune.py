"""The tables of numbers that affect speed only, and the page that scripts/bench tune makes of them."""

import pathlib
import re

import bench_tune
import cartridges

ROOT = cartridges.ROOT
FOLDERS = ("agents", "emulator", "environment", "games", "protocol", "recording", "server", "system")


def sources():
    for folder in FOLDERS:
        yield from (path for path in (ROOT / folder).rglob("*.[hc]pp"))


class TestTuningTables:
    rows = [row for file in bench_tune.TUNING_TABLES for row in bench_tune.read_tuning_table(file)]

    def test_every_row_is_read_with_its_meaning(self):
        calls = [
            path.relative_to(ROOT).as_posix()
            for path in sources()
            for _ in re.finditer(r"^RACEBEAM_TUNED\(", path.read_text(), re.MULTILINE)
        ]
        assert sorted(calls) == sorted(row["file"] for row in self.rows)
        assert len(self.rows) > 40

    def test_names_are_unique_and_used(self):
        names = [row["name"] for row in self.rows]
        assert len(names) == len(set(names))
        tables = {ROOT / file for file in bench_tune.TUNING_TABLES}
        text = "".join(path.read_text() for path in sources() if path not in tables)
        assert [name for name in names if f"tuning::{name}" not in text] == []

    def test_what_measures_a_row_exists(self):
        assert {row["measure"] for row in self.rows} <= {*bench_tune.MEASURES, "none"}

    def test_policies_are_switched_off_by_rows(self):
        numbers = {name for values in bench_tune.POLICIES.values() for name in values}
        assert numbers <= {row["name"] for row in self.rows}

    def test_a_policy_that_saves_little_says_why_it_stays(self):
        assert set(bench_tune.REASONS) <= set(bench_tune.POLICIES)
        page = pathlib.Path(bench_tune.PAGE).read_text()
        table = page[page.index("| policy |") :].split("\n\n")[0].splitlines()[2:]
        for name, *figures in ([cell.strip() for cell in row.strip("|").split("|")] for row in table):
            saves = max(float(figures[0]), float(figures[2])) >= 1.02
            assert saves or name in bench_tune.REASONS, name

    def test_the_page_has_each_row_with_its_value(self, subtests):
        page = pathlib.Path(bench_tune.PAGE).read_text()
        for row in self.rows:
            with subtests.test(row["name"]):
                assert f"| `{row['name']}` | {row['value']:,} | {row['unit']} | {row['measure']} |" in page

    def test_the_tables_are_written_anew_without_measuring(self):
        page = pathlib.Path(bench_tune.PAGE).read_text()
        assert bench_tune.with_tuning_tables(page, self.rows) == page
        new = {**self.rows[0], "name": "kNew", "value": 12345}
        assert new["measure"] in bench_tune.MEASURES
        text = bench_tune.with_tuning_tables(page, [*self.rows[1:], new])
        assert f"| `{self.rows[0]['name']}` |" in page
        assert f"| `{self.rows[0]['name']}` |" not in text
        assert f"| `{self.rows[1]['name']}` |" in text
        [missing] = re.findall(r"This run did not measure ([^.]*)\.", text)
        assert "`kNew`" in missing and f"`{self.rows[1]['name']}`" not in missing
        assert "| `kNew` | 12,345 |" in text


class TestFigures:
    def test_the_ratio_of_a_variant_is_the_median_of_the_turns(self):
        times = [[1.0, 2.0, 0.5], [2.0, 4.0, 1.0], [1.0, 9.0, 0.1]]
        assert bench_tune.ratios(times) == [1.0, 2.0, 0.5]

    def test_a_row_has_the_mean_of_the_games_and_the_worst(self, cleanup):
        of_game = {"pong": [1.0, 2.0], "qbert": [1.0, 0.5]}
        bench_tune.MEASURES["test"] = lambda game, variants, options: of_game[game]
        cleanup(bench_tune.MEASURES.pop, "test")

        class Options:
            games = ["pong", "qbert"]

        assert bench_tune.measure("test", [{}, {}], Options) == [(1.0, 2.0, "pong")]

    def test_other_numbers_are_told_by_the_environment(self):
        assert bench_tune.variable({"kA": 1, "kB": 2}) == {"RACEBEAM_TUNING": "kA=1 kB=2"}
