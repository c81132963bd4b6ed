"""Tables, documents and the folder of a report."""

import os

import package
import pytest

package.require()

import pandas as pd
from racebeam_evaluation import BadInput
from racebeam_evaluation.csv_file import Source
from racebeam_evaluation.output import folder
from racebeam_evaluation.output.report import Report
from racebeam_evaluation.output.table import Table

SOURCES = (Source("results.csv", "00ff"), Source("other.csv", "11ee"))


def table(rows=1, **others):
    frame = pd.DataFrame({"game": ["a_b"] * rows, "low": 0.5, "high": 2.0})
    return Table("made", "A caption.", frame, SOURCES, **others)


class TestTable:
    NUMBERS = pd.DataFrame({"game": ["a_b", "c"], "n": [1, 2], "x": [1 / 3, float("nan")], "y": [-0.00001, 2.5]})

    def test_csv_has_all_digits_below_the_sources(self):
        assert Table("made", "A caption.", self.NUMBERS, SOURCES).csv() == (
            "# made from results.csv sha256:00ff\n# made from other.csv sha256:11ee\n"
            "game,n,x,y\na_b,1,0.333333333333,-1e-05\nc,2,n/a,2.5\n"
        )

    def test_markdown_has_three_digits_and_no_negative_zero(self):
        assert Table("made", "A caption.", self.NUMBERS, SOURCES[:1], ("First.", "Second.")).markdown() == (
            "A caption.\n\n| game | n | x | y |\n| --- | ---: | ---: | ---: |\n"
            "| a_b | 1 | 0.333 | 0.000 |\n| c | 2 | n/a | 2.500 |\n\n"
            "First.\n\nSecond.\n\n<!-- made from results.csv sha256:00ff -->\n"
        )

    def test_latex_escapes_names_and_has_the_notes_as_comments(self):
        assert Table("made", "A caption.", self.NUMBERS, SOURCES[:1], ("A note.",), digits=1).latex() == (
            "% A caption.\n% A note.\n% made from results.csv sha256:00ff\n"
            "\\begin{tabular}{lrrr}\n\\toprule\ngame & n & x & y \\\\\n\\midrule\n"
            "a\\_b & 1 & 0.3 & 0.0 \\\\\nc & 2 & n/a & 2.5 \\\\\n\\bottomrule\n\\end{tabular}\n"
        )

    def test_a_bar_in_a_name_ends_no_cell_of_markdown(self):
        made = Table("made", "A caption.", pd.DataFrame({"agent": ["a|b"], "x": [1]}), ())
        assert "| a\\|b | 1 |\n" in made.markdown()
        assert "a|b & 1 \\\\\n" in made.latex()

    def test_a_name_is_neither_a_command_of_latex_nor_a_tag_of_markdown(self):
        name = r"\input{~a^}<b>|"
        made = Table("made", "A caption.", pd.DataFrame({name: [1], "agent": [name]}), ())
        escaped = r"\textbackslash{}input\{\textasciitilde{}a\textasciicircum{}\}<b>|"
        assert f"{escaped} & agent \\\\\n\\midrule\n1 & {escaped} \\\\\n" in made.latex()
        escaped = r"\input{~a^}\<b>\|"
        assert f"| {escaped} | agent |\n| ---: | --- |\n| 1 | {escaped} |\n" in made.markdown()

    def test_the_best_cells_of_a_row_are_bold_and_others_are_not(self):
        frame = pd.DataFrame({"game": ["x", "y"], "a": [1.0, 2], "b": [3.0, 2], "published": [9.0, 9]})
        made = Table("made", "A caption.", frame, (), digits=0, best_of=("a", "b"))
        assert "| x | 1 | **3** | 9 |\n| y | **2** | **2** | 9 |\n" in made.markdown()
        assert "x & 1 & \\textbf{3} & 9 \\\\\ny & \\textbf{2} & \\textbf{2} & 9 \\\\\n" in made.latex()

    def test_the_three_files_have_the_name_of_the_table(self):
        made = table()
        assert made.files() == {"made.csv": made.csv(), "made.md": made.markdown(), "made.tex": made.latex()}


class TestReport:
    def test_a_table_of_more_than_120_rows_is_a_link(self):
        report = Report("A title", ["One.", "Two."], SOURCES[:1])
        report.add_table(table(120))
        assert "| a_b | 0.500 | 2.000 |" in report.document()
        report.parts = [table(121)]
        assert report.document() == (
            "# A title\n\nOne. Two.\n\n- made from results.csv sha256:00ff\n\n"
            "## Table made\n\nA caption.\n\n[121 rows](tables/made.csv)\n"
        )

    def test_an_empty_table_is_left_out(self):
        report = Report("A title", [], (), untested=["Not tested: x."])
        report.add_table(table(0))
        assert (report.parts, report.document()) == ([], "# A title\n\nNot tested: x.\n")
        report.add_table(table(1))
        assert sorted(report.files()) == ["report.md", "tables/made.csv", "tables/made.md", "tables/made.tex"]


class TestFolder:
    def test_files_and_copies_are_written_into_a_new_or_an_empty_folder(self, tmp_path):
        (tmp_path / "from").write_bytes(b"copy")
        (tmp_path / "empty").mkdir()
        for name in ("empty", "new"):
            folder.write(tmp_path / name, {"a/b.txt": b"bytes", "c": tmp_path / "from"})
            assert (tmp_path / name / "a/b.txt").read_bytes() == b"bytes"
            assert (tmp_path / name / "c").read_bytes() == b"copy"
        assert sorted(path.name for path in tmp_path.iterdir()) == ["empty", "from", "new"]

    def test_a_link_is_not_followed(self, tmp_path):
        (tmp_path / "link").symlink_to("/etc/hostname")
        folder.write(tmp_path / "new", {"a": tmp_path / "link"})
        assert (tmp_path / "new/a").is_symlink()

    def test_what_is_there_stays(self, tmp_path):
        (tmp_path / "full").mkdir()
        for place in (tmp_path / "full/file", tmp_path / "file"):
            place.write_bytes(b"mine")
        for name in ("full", "file"):
            with pytest.raises(BadInput, match=f"{name} is not empty; expected a new or an empty folder"):
                folder.write(tmp_path / name, {"a": b"1"})
        with pytest.raises(BadInput, match="/file is not a folder; expected the folder in which in is made"):
            folder.check_free(tmp_path / "file/in")
        assert sorted(path.name for path in tmp_path.rglob("*")) == ["file", "file", "full"]

    def test_a_file_that_cannot_be_copied_leaves_nothing(self, tmp_path):
        with pytest.raises(BadInput, match="new cannot be written: No such file or directory; expected a folder with"):
            folder.write(tmp_path / "new", {"a": b"1", "b": tmp_path / "none"})
        assert list(tmp_path.iterdir()) == []

    def test_a_path_without_a_folder_is_in_the_working_folder(self, tmp_path, monkeypatch):
        monkeypatch.chdir(tmp_path)
        folder.write(type(tmp_path)("new"), {"a": b"1"})
        assert os.listdir(tmp_path) == ["new"]
