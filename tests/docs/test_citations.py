"""Comments cite documents and sections that exist. Also tests the check itself."""

import pathlib
import tempfile

import citations

DOCUMENT = """# Chip

## 1. Clocks

## 2. Lines

### Greying

## How to check

| # | Case |
|---|---|
| 1 | one |
| 2 | two |
"""


def problems(source, name="part.cpp"):
    """The output of the check for a tree with DOCUMENT as the specification of a chip, and this source."""
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder)
        (root / "docs/spec").mkdir(parents=True)
        (root / "docs/spec/chip.md").write_text(DOCUMENT)
        (root / name).write_text(source)
        return citations.faults(root)


class TestTheCheck:
    def refuses(self, source, sentence, name="part.cpp"):
        count, wrong = problems(source, name)
        assert count == 1
        assert len(wrong) == 1
        assert sentence in wrong[0]

    def accepts(self, source, name="part.cpp", count=1):
        assert problems(source, name) == (count, [])

    def test_it_accepts_what_exists(self):
        self.accepts("// A chip (docs/spec/chip.md).\n")
        self.accepts("int a;  // docs/spec/chip.md, 1 and 2\n")
        self.accepts("// docs/spec/chip.md, 1 to 2.\n")
        self.accepts('// docs/spec/chip.md, "Greying": what is seen\n')
        self.accepts('// docs/spec/chip.md, "How to check", 1 and 2\n')
        self.accepts("// (docs/spec/chip.md, 1; docs/spec/chip.md, 2)\n", count=2)

    def test_it_refuses_a_document_that_is_not_there(self):
        self.refuses("// docs/spec/chop.md, 1\n", "docs/spec/chop.md does not exist")
        self.refuses("// chip.md, 1\n", "chip.md does not exist")

    def test_it_refuses_a_section_that_is_not_there(self):
        self.refuses("// docs/spec/chip.md, 3\n", "has no section 3")
        self.refuses("// docs/spec/chip.md, 1 to 4\n", "has no section 3")
        self.refuses("// docs/spec/chip.md, 1, 2 and 7\n", "has no section 7")
        self.refuses('// docs/spec/chip.md, "Grey"\n', 'has no section "Grey"')

    def test_it_refuses_a_case_that_is_not_there(self):
        self.refuses('// docs/spec/chip.md, "How to check", 2 and 3\n', "has no case 3")

    def test_it_refuses_sections_cited_in_another_form(self):
        self.refuses("// docs/spec/chip.md, section 1\n", "only by its number")

    def test_it_reads_citations_over_the_end_of_a_line(self):
        self.refuses("  // as it stands in docs/spec/chip.md,\n  // 3, and nowhere else\n", "has no section 3")
        self.refuses('// docs/spec/chip.md, "How to\n// chock"\n', 'has no section "How to chock"')

    def test_it_reads_docstrings_and_comments_of_python_but_no_other_text(self):
        self.refuses('"""docs/spec/chip.md, 9."""\n', "has no section 9", "part.py")
        self.refuses("a = 1  # docs/spec/chip.md, 9\n", "has no section 9", "part.py")
        self.accepts('out = "report.md"\n', "part.py", count=0)

    def test_it_reads_scripts_and_game_files(self):
        self.refuses("#!/bin/sh\n# docs/spec/chip.md, 9\n", "has no section 9", "script")
        self.refuses('evidence = "docs/spec/chip.md, 9."\n', "has no section 9", "game.toml")


class TestThisTree:
    def test_every_citation_leads_somewhere(self):
        count, wrong = citations.faults()
        assert count > 100
        assert wrong == [], "\n".join(wrong)
