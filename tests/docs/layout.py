"""Rules for every document of this tree: links and paths exist, lines have at most 100 columns, tables have
headings."""

import re

import markdown
from tree import ROOT, documents

WIDTH = 100
TREE_PATH = re.compile(r"`([a-z.][\w.-]*/[\w./-]*\w\.(?:cpp|hpp|inc|md|py|txt|toml|svg)|scripts/[\w/-]+)[ `]")


def link_faults(root, path, text):
    """Links to missing files, out of the tree, or to missing headings, and links with a blank or a line break."""
    for number, target in markdown.links(text):
        if re.search(r"\s", target):
            yield number, f"{' '.join(target.split())!r} has a blank or a line break"
            continue
        if re.match(r"[a-z]+:", target):  # an address; nothing is fetched
            continue
        name, _, anchor = target.partition("#")
        found = (root / path.parent / name).resolve() if name else root / path
        if not found.is_relative_to(root.resolve()) and name:
            yield number, f"{target} leads out of the tree"
        elif not found.exists():
            yield number, f"{target} does not exist"
        elif anchor and anchor not in markdown.anchors(found.read_text()):
            yield number, f"{name or path.name} has no heading #{anchor}"


def path_faults(root, document, text):
    """Paths in backticks that do not exist, relative to the root of the tree or to the document's folder.
    Names in capitals are placeholders, and are left out."""
    for number, line in markdown.prose(text):
        for path in TREE_PATH.findall(line):
            ours = (root / path.split("/")[0]).is_dir() and not re.search(r"NAME|TARGET", path)
            if ours and not (root / path).exists() and not (root / document.parent / path).exists():
                yield number, f"{path} does not exist"


def width_faults(text):
    """Lines of prose that are too wide. Tables, code, and what cannot be broken may be wider."""
    for number, line in markdown.prose(text):
        unbreakable = " " not in re.sub(r"`[^`]*`", "x", line.strip())
        if len(line) > WIDTH and not line.lstrip().startswith("|") and not unbreakable:
            yield number, f"{len(line)} columns, more than {WIDTH}"


def table_faults(text):
    """Tables in which a column has no heading."""
    lines = list(markdown.prose(text))
    for (number, line), (_, below) in zip(lines, lines[1:]):
        is_heading = re.match(r"\s*\|[\s:|-]+\|$", below) and line.lstrip().startswith("|")
        if is_heading and not all(cell.strip() for cell in line.strip().strip("|").split("|")):
            yield number, "a column of the table has no heading"


def faults(root=ROOT):
    """Returns the number of documents below `root`, and a line for each error in them."""
    wrong = []
    for path in documents(root):
        text = (root / path).read_text()
        for number, problem in [
            *link_faults(root, path, text),
            *path_faults(root, path, text),
            *width_faults(text),
            *table_faults(text),
        ]:
            wrong.append(f"{path}:{number}: {problem}")
    return len(documents(root)), wrong
