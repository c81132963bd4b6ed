"""The documents name what is public in the Python package, and docs/python/reference.md the methods of a session."""

import ast
import re

import tree

PACKAGE = tree.ROOT / "clients/python/racebeam"
MODULES = ("", "cluster", "envpool", "episode_log", "errors", "results", "sb3", "testing", "wire/aio", "wire/client")
PAGES = tree.ROOT / "docs"
BLOCK = re.compile(r"^```[\w-]*\n(.*?)^```", re.DOTALL | re.MULTILINE)
SPAN = re.compile(r"`[^`]+`")
CALL = re.compile(r"`(\w+)\(([^`]*)\)`")


def parse(module):
    path = PACKAGE / module
    return ast.parse((path / "__init__.py" if path.is_dir() else path.with_suffix(".py")).read_text())


def public_names(module):
    """The names of __all__ of a module."""
    for node in parse(module).body:
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "__all__":
            return ast.literal_eval(node.value)
    raise AssertionError(f"{module} has no __all__")


def methods(module, name):
    """The public methods of a class, with their arguments as a caller writes them."""
    [found] = (node for node in parse(module).body if isinstance(node, ast.ClassDef) and node.name == name)
    return {
        node.name: arguments(node.args)
        for node in found.body
        if isinstance(node, ast.FunctionDef) and not node.name.startswith("_")
    }


def arguments(listed):
    """The arguments of a method as text, without their types and without self or cls."""
    for argument in (*listed.args, *listed.kwonlyargs, listed.vararg, listed.kwarg):
        if argument:
            argument.annotation = None
    return ast.unparse(listed).replace("'", '"').partition(", ")[2]


def code(text):
    """What a page shows as code: its blocks, and its spans between backticks."""
    return "\n".join((*BLOCK.findall(text), *SPAN.findall(BLOCK.sub("", text))))


class TestPublicNames:
    def test_each_name_is_in_a_page(self):
        text = "\n".join(code(page.read_text()) for page in sorted(PAGES.rglob("*.md")))
        missing = [
            f"{module or 'racebeam'}: {name}"
            for module in MODULES
            for name in public_names(module)
            if not re.search(rf"\b{name}\b", text)
        ]
        assert missing == []

    def test_each_method_of_a_session_is_in_the_document_with_its_arguments(self):
        section = (PAGES / "python/reference.md").read_text().split("## Sessions")[1].split("\n| address |")[0]
        calls = dict(CALL.findall(section))
        for module, name in (("wire/commands", "Commands"), ("wire/session", "Session")):
            for method, arguments in methods(module, name).items():
                assert calls.pop(method, None) == arguments, method
        assert calls == {}, "a session lacks these methods"
