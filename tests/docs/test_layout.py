"""Links and paths exist, lines fit, tables have headings. Also tests the check itself."""

import pathlib
import tempfile

import layout

OTHER = "# Other\n\n## 1. One `thing`, and more\n"


def problems(text):
    """The output of the check for a tree with this text as a document, and OTHER."""
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        (root / "docs").mkdir()
        (root / "docs/one.md").write_text(text)
        (root / "docs/other.md").write_text(OTHER)
        count, wrong = layout.faults(root)
        assert count == 2
        return wrong


class TestTheCheck:
    def refuses(self, text, sentence):
        wrong = problems(text)
        assert len(wrong) == 1, wrong
        assert sentence in wrong[0]

    def test_it_accepts_links_that_lead_somewhere(self):
        for text in (
            "# One\n\n[a](other.md) [b](other.md#1-one-thing-and-more) [c](#one) [d](../docs)\n",
            "[a page](https://example.org/x) and `[no](link.md)`\n\n```\n[no](code.md)\n```\n",
        ):
            assert problems(text) == []

    def test_it_refuses_links_that_do_not(self):
        self.refuses("[a](another.md)\n", "docs/one.md:1: another.md does not exist")
        self.refuses("\n![a](picture.svg)\n", "docs/one.md:2: picture.svg does not exist")
        self.refuses("[a](other.md#two)\n", "other.md has no heading #two")
        self.refuses("# One\n\n[a](#two)\n", "one.md has no heading #two")
        self.refuses("[a text over\ntwo lines](another.md)\n", "another.md does not exist")
        self.refuses("[a](../../elsewhere.md)\n", "leads out of the tree")
        self.refuses("[a](oth-\n  er.md)\n", "docs/one.md:2: 'oth- er.md' has a blank or a line break")

    def test_it_refuses_paths_of_the_tree_that_are_not_there(self):
        self.refuses("See `docs/three.md` and `docs/other.md`.\n", "docs/one.md:1: docs/three.md does not exist")
        assert problems("`docs/NAME.md`, `elsewhere/a.md`, and `docs/*.md`\n") == []

    def test_it_refuses_wide_lines_but_not_tables_and_code(self):
        self.refuses("word " * 21 + "\n", "docs/one.md:1: 105 columns")
        assert problems("| a |\n|---|\n| " + "word " * 21 + "|\n") == []
        assert problems("```\n" + "word " * 21 + "\n```\n") == []

    def test_it_refuses_tables_without_headings(self):
        self.refuses("| a | |\n|---|---|\n| 1 | 2 |\n", "docs/one.md:1: a column of the table has no heading")
        assert problems("| a | b |\n|---|---:|\n| 1 | |\n") == []


class TestThisTree:
    def test_every_document_keeps_to_it(self):
        count, wrong = layout.faults()
        assert count > 10
        assert wrong == [], "\n".join(wrong)
