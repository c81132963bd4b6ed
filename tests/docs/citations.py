"""Finds what comments cite, and says which citations lead nowhere.

A citation is the path of a document from the root of the tree, and perhaps where to look in it:

    docs/spec/tia.md                                 the document
    docs/spec/tia.md, 4 and 7 to 9                   its numbered sections
    docs/spec/tia.md, "Cosmic Ark mode"              a section by its heading
    docs/spec/tia.md, "How to check", 1 to 3         cases: rows of that section's tables, by their first column
"""

import ast
import io
import pathlib
import re
import tokenize

import markdown
from tree import ROOT, files

NUMBERS = r"\d+(?:(?:, | to | and )\d+)*(?!\w|%|\.\d)"
CITATION = re.compile(rf'([\w./-]*\w\.md)\b(?:, ({NUMBERS})|, "([^"]*)"(?:, ({NUMBERS}))?)?')
WITHOUT_COMMENTS = {".md", ".svg", ".bin", ".json", ".txt"}


def slash_comments(text):
    """Comments of C++, with the lines of one comment joined."""
    lines = [re.search(r"//(?!/)\s?(.*)", line) for line in text.splitlines()]
    return "\n".join(line[1] if line else "" for line in lines)


def python_comments(text):
    """Comments and docstrings."""
    comments = {
        token.start[0]: token.string.lstrip("# ")
        for token in tokenize.generate_tokens(io.StringIO(text).readline)
        if token.type == tokenize.COMMENT
    }
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, (ast.Module, ast.ClassDef, ast.FunctionDef)) and ast.get_docstring(node, clean=False):
            comments.update(enumerate(ast.get_docstring(node, clean=False).splitlines(), node.body[0].lineno))
    return "\n".join(comments.get(number, "") for number in range(1, max(comments, default=0) + 1))


def hash_comments(text):
    """The whole of a script, list or game file: it names no other kind of document."""
    return "\n".join(line.strip().lstrip("# ") for line in text.splitlines())


def menu_comments(text):
    """Comments of a list of pages, some of which are made by a script."""
    return "\n".join(line.partition("#")[2] for line in text.splitlines())


def comments(path, text):
    if path.suffix in (".cpp", ".hpp", ".inc", ".h", ".cc"):
        return slash_comments(text)
    if path.suffix == ".py" or text.startswith("#!/usr/bin/env python3"):
        return python_comments(text)
    if path.suffix == ".yml":
        return menu_comments(text)
    return hash_comments(text)


def numbers(text):
    """4 and 7 to 9: [4, 7, 8, 9]."""
    found = []
    for part in re.split(r", | and ", text):
        first, _, last = part.partition(" to ")
        found += range(int(first), int(last or first) + 1)
    return found


def fault(root, citation):
    """The error in a citation, or None."""
    name, section_numbers, heading, cases = citation.groups()
    if re.match(r",? sections?\b", citation.string[citation.end() :]):
        return "a section is cited only by its number, after a comma"
    if not (root / name).is_file():
        return f"{name} does not exist"
    sections = markdown.sections((root / name).read_text())
    if section_numbers:
        missing = sorted(set(numbers(section_numbers)) - {section.number() for section in sections})
        return f"{name} has no section {missing[0]}" if missing else None
    if heading is None:
        return None
    found = next((section for section in sections if section.heading == heading), None)
    if not found:
        return f'{name} has no section "{heading}"'
    missing = sorted(set(numbers(cases or "")) - found.cases()) if cases else []
    return f'{name}, "{heading}" has no case {missing[0]}' if missing else None


def citations(path, text):
    """(line number, match) of each citation in the comments of a file."""
    joined = comments(path, text)
    flat = joined.replace("\n", " ")
    for found in CITATION.finditer(flat):
        yield joined.count("\n", 0, found.start()) + 1, found


def faults(root=ROOT):
    """Returns the number of citations below `root`, and a line for each whose target does not exist."""
    count, wrong = 0, []
    for path in files(root):
        if path.suffix in WITHOUT_COMMENTS:
            continue
        try:
            text = (root / path).read_text()
        except UnicodeDecodeError:
            continue
        for number, citation in citations(pathlib.Path(path), text):
            count += 1
            problem = fault(root, citation)
            if problem:
                wrong.append(f"{path}:{number}: {problem} ({citation[0]})")
    return count, wrong
