"""Tests of what scripts/site does besides mkdocs: the pages that it makes, and the check of links."""

import pathlib
import re
import sys
import tempfile

from tree import ROOT, documents

sys.path.insert(0, str(ROOT / "docs/site"))
import links  # noqa: E402
import pages  # noqa: E402


class TestPages:
    def test_links_to_folders_and_files_are_kept_where_they_lead_somewhere(self):
        linked = set()
        text = "[a](spec) [b](pictures) [c](../README.md#x) [d](pictures/draw.py)\n```\n[e](spec)\n```\n"
        page = pages.for_the_site(pathlib.Path("docs/one.md"), text, linked)
        assert page == "[a](spec/README.md) b [c](../README.md#x) [d](pictures/draw.py)\n```\n[e](spec)\n```\n"
        assert linked == {pathlib.Path("docs/pictures/draw.py")}

    def test_the_tables_are_those_of_the_description(self):
        protocol = pages.description.read()
        for title, heads in pages.TABLES.values():
            page = pages.table_page(protocol, title, heads)
            for head in heads:
                assert head in page
        assert "| `bad-action` |" in pages.table_page(protocol, *pages.TABLES["errors"])

    def test_each_public_name_of_python_is_on_a_page(self):
        page = pages.python_page("racebeam", "All")
        for name in pages.public_names("racebeam"):
            assert re.search(rf"(::: racebeam\.|`){name}\b", page)
        assert "`Action`" in page  # compiled
        assert "::: racebeam.AtariEnv\n" in page

    def test_the_first_page_leads_to_the_page_to_play_on(self):
        title, first, link, rest = pages.with_link_to_try("# A\n\nb\nc\n\nd\n\ne\n").split("\n\n", 3)
        assert (title, first, rest.split("\n\n", 1)[1]) == ("# A", "b\nc", "d\n\ne\n")
        assert 'href="try/index.html"' in link

    def test_the_menu_has_each_document(self):
        menu = (ROOT / "docs/site/mkdocs.yml").read_text().partition("\nnav:\n")[2]
        entries = set(re.findall(r"[\w./-]+\.md", menu))
        generated = {f"reference/{name}.md" for name in ("cpp", *pages.TABLES)}
        generated |= {f"reference/python/{module}.md" for module in pages.MODULES}
        assert {str(path) for path in documents()} | generated == entries


class TestLinks:
    def faults(self, text):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / "one.html").write_text(text)
            (root / "two.html").write_text('<h1 id="here">Two</h1>')
            return list(links.faults(root.resolve()))

    def test_links_that_lead_somewhere_are_accepted(self):
        for target in ("two.html", "two.html#here", "/two.html", "#", "https://example.org/x", "mailto:a@example.org"):
            assert self.faults(f'<a href="{target}">a</a>') == []

    def test_pages_that_load_from_elsewhere_are_refused(self):
        for text in ('<script src="{}"></script>', '<img src="{}">', '<link rel="stylesheet" href="{}">'):
            address = "https://example.org/x"
            assert self.faults(text.format(address)) == [f"one.html: loads {address} from elsewhere"]
        assert self.faults('<link rel="canonical" href="https://example.org/x"><img src="data:image/png,">') == []

    def test_links_that_do_not_are_refused(self):
        assert self.faults('<img src="a.png">') == ["one.html: a.png does not exist"]
        assert self.faults('<a href="two.html#x">') == ["one.html: two.html#x has no such anchor"]
