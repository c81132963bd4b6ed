"""Lays out what mkdocs reads: the documents of the tree, the files that they link to, and pages made from tables.

Usage: pages.py FOLDER [PAGE]. FOLDER is emptied first. PAGE is a folder with the page of viewer/ without a server. It
becomes part of the site, and the first page links to it.
"""

import ast
import pathlib
import re
import shutil
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path += [str(ROOT / "tests/docs"), str(ROOT / "protocol/description")]
import description  # noqa: E402
import document  # noqa: E402
import markdown  # noqa: E402
from tree import documents  # noqa: E402

PACKAGE = ROOT / "clients/python/racebeam"
MODULES = {
    "racebeam": "Games, environments, sessions",
    "racebeam.envpool": "The interface of EnvPool",
    "racebeam.sb3": "Environments for Stable-Baselines3",
    "racebeam.wire.client": "The client of the line protocol",
    "racebeam.wire.aio": "Sessions for asyncio",
    "racebeam.episode_log": "Logs of episodes",
    "racebeam.testing": "Tests for wrappers",
    "racebeam.cluster": "Servers in a cluster",
    "racebeam.errors": "Errors",
}
TABLES = {
    "settings": ("Settings of a game", ("| setting | values | default | meaning |", "| preset | sets | source |")),
    "fields": ("Fields of replies", ("| field | content | encoding |", "| encoding | form |")),
    "errors": ("Errors", ("| code | meaning |",)),
}
TRY = """<p><a class="md-button md-button--primary" href="try/index.html">Try it in the browser</a></p>

It plays Beamfall, Updraft, and images from your disk. Nothing is sent anywhere.

"""
LINK = re.compile(r"(!?)\[([^\]]*)\]\(([^)\s#]+)(#[^)\s]*)?\)")


def parse(module):
    """The source of a module of the package, or None for the part that is C++."""
    path = PACKAGE.parent / module.replace(".", "/")
    file = path / "__init__.py" if path.is_dir() else path.with_suffix(".py")
    return ast.parse(file.read_text()) if file.exists() else None


def public_names(module):
    """The names of __all__ of a module."""
    [names] = (
        ast.literal_eval(node.value)
        for node in parse(module).body
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "__all__"
    )
    return sorted(names)


def is_python(module, name):
    """Whether a name is defined in Python. If not, its text is in the compiled part, which only a build has."""
    source = parse(module)
    if source is None:
        return False
    is_package = (PACKAGE.parent / module.replace(".", "/")).is_dir()
    for node in ast.walk(source):
        if isinstance(node, ast.ImportFrom) and node.level:
            for imported in node.names:
                if (imported.asname or imported.name) == name:
                    parents = module.split(".")[: len(module.split(".")) - node.level + is_package]
                    return is_python(".".join([*parents, node.module]), imported.name)
    return True


def python_page(module, title):
    """The page of a module, whose texts mkdocstrings takes from the sources."""
    names = public_names(module)
    compiled = [name for name in names if not is_python(module, name)]
    links = ", ".join(f"`{name}`" for name in compiled)
    note = f"`help()` also describes the classes that are compiled: {links}.\n\n" if compiled else ""
    entries = "".join(f"::: {module}.{name}\n\n" for name in names if name not in compiled)
    return f"# {title}\n\n`import {module}`\n\n{note}{entries}"


def table_page(protocol, title, heads):
    """The tables with these headings, as protocol/protocol.toml has them."""
    tables = document.tables(protocol)
    text = "\n".join(f"{head}\n{re.sub('[^|]+', '---', head)}\n" + "".join(tables[head]) for head in heads)
    links = text.replace("](#", "](../protocol/PROTOCOL.md#")
    return f"# {title}\n\n[PROTOCOL.md](../protocol/PROTOCOL.md) says how they are used.\n\n{links}"


def for_the_site(path, text, linked):
    """A document whose links to folders lead to their pages. Adds the files that it links to to `linked`."""

    def link(found):
        mark, words, target, anchor = found.groups()
        if re.match(r"[a-z]+:", target):
            return found[0]
        file = (ROOT / path.parent / target).resolve()
        if file.is_dir():
            if not (file / "README.md").exists():
                return words
            return f"{mark}[{words}]({target.rstrip('/')}/README.md{anchor or ''})"
        if file.suffix != ".md":
            linked.add(file.relative_to(ROOT))
        return found[0]

    prose = {number for number, _ in markdown.prose(text)}
    parts = re.split(r"(?m)^(?=.)", text) if not prose else text.splitlines(keepends=True)
    blocks, pending = [], ""
    for number, line in enumerate(parts, 1):
        if number in prose:
            pending += line
        else:
            blocks += [LINK.sub(link, pending), line]
            pending = ""
    return "".join([*blocks, LINK.sub(link, pending)])


def with_link_to_try(text):
    """The first page, with the link before its second paragraph."""
    title, first, rest = text.split("\n\n", 2)
    return f"{title}\n\n{first}\n\n{TRY}{rest}"


def lay_out(into, page=None):
    """Writes all pages and files into an empty folder."""
    linked = set()
    for path in documents():
        write(into / path, for_the_site(path, (ROOT / path).read_text(), linked))
    for path in linked:
        (into / path).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(ROOT / path, into / path)
    protocol = description.read()
    for name, (title, heads) in TABLES.items():
        write(into / f"reference/{name}.md", table_page(protocol, title, heads))
    for module, title in MODULES.items():
        write(into / f"reference/python/{module}.md", python_page(module, title))
    shutil.copytree(ROOT / "build/api/html", into / "reference/cpp")
    if page:
        shutil.copytree(page, into / "try")
        write(into / "README.md", with_link_to_try((into / "README.md").read_text()))
    write(
        into / "reference/cpp.md",
        "# Classes for C++\n\n- [Classes](cpp/annotated.html)\n- [Their members](cpp/functions.html)\n"
        "- [Headers](cpp/files.html)\n",
    )


def write(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)


if __name__ == "__main__":
    folder, *page = map(pathlib.Path, sys.argv[1:])
    shutil.rmtree(folder, ignore_errors=True)
    lay_out(folder, *page)
