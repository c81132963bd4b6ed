"""In a Python file, a later class or method of the same name would hide an earlier one, tests included."""

import ast
import collections

from tree import ROOT, files


def hidden(path):
    """A line for each name that a module or a class defines twice. Properties have setters of their name."""
    tree = ast.parse((ROOT / path).read_text())
    for scope in [tree, *(node for node in ast.walk(tree) if isinstance(node, ast.ClassDef))]:
        kinds = ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef
        plain = [node for node in scope.body if isinstance(node, kinds) and not node.decorator_list]
        counts = collections.Counter(node.name for node in plain)
        yield from (
            f"{path}: {name} is defined {count} times, and the last hides the others"
            for name, count in counts.items()
            if count > 1
        )


def test_no_test_hides_another_of_its_name():
    sources = [path for path in files() if path.suffix == ".py"]
    assert sources
    assert [line for path in sources for line in hidden(path)] == []


def test_a_name_that_is_defined_twice_is_found(tmp_path):
    path = tmp_path / "test_x.py"
    path.write_text("class A:\n    def a(self):\n        pass\n\n    def a(self):\n        pass\n")
    assert list(hidden(path)) == [f"{path}: a is defined 2 times, and the last hides the others"]
