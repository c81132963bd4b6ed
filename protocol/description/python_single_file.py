"""The client in Python as a single file: the modules of racebeam.wire that it needs, one after the other."""

import ast
import collections

HEAD = "# Made from clients/python/racebeam/wire by protocol/description/generate. Do not change it by hand.\n"
MODULES = (
    "messages",
    "encodings",
    "fields",
    "observations",
    "addresses",
    "transport",
    "connection",
    "replies",
    "exchange",
    "commands",
    "session",
    "stack",
    "opening",
    "client",
)  # each after those that it imports; the last has the docstring and __all__


def is_docstring(node):
    return isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)


def is_export_list(node):
    return isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "__all__"


def defined(tree):
    """The names that a module defines."""
    for node in tree.body:
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            yield node.name
        elif isinstance(node, (ast.Assign, ast.AnnAssign)) and not is_export_list(node):
            yield ast.unparse(node.targets[0] if isinstance(node, ast.Assign) else node.target)


def body(name, text):
    """The lines of a module after its imports. Only the last module keeps its __all__."""
    tree = ast.parse(text)
    dropped = [
        node
        for node in tree.body
        if is_docstring(node)
        or isinstance(node, (ast.Import, ast.ImportFrom))
        or is_export_list(node)
        and name != MODULES[-1]
    ]
    lines = text.splitlines()
    for node in dropped:
        lines[node.lineno - 1 : node.end_lineno] = [None] * (node.end_lineno - node.lineno + 1)
    return "\n".join(line for line in lines if line is not None).strip()


def group(name):
    """Ruff sorts constants before classes, and functions last."""
    return 0 if name.isupper() else 1 if name[0].isupper() else 2


def imports(trees):
    """The imports of the standard library, as Ruff sorts them."""
    plain, members = set(), collections.defaultdict(set)
    for node in (node for tree in trees for node in tree.body):
        if isinstance(node, ast.Import):
            plain |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.level == 0 and node.module != "__future__":
            members[node.module] |= {alias.name for alias in node.names}
    froms = [
        f"from {module} import {', '.join(sorted(names, key=lambda name: (group(name), name)))}"
        for module, names in sorted(members.items())
    ]
    return "\n".join(["from __future__ import annotations", "", *(f"import {name}" for name in sorted(plain)), *froms])


def joined(modules):
    """The text of the single file.

    A module imports names of the others, not modules, so that their definitions can stand one after the other. Two
    modules that define the same name raise ValueError.
    """
    trees = {name: ast.parse(text) for name, text in modules.items()}
    counts = collections.Counter(name for tree in trees.values() for name in defined(tree))
    if twice := [name for name, count in counts.items() if count > 1]:
        raise ValueError(f"two modules of the client in Python define {', '.join(twice)}")
    docstring = modules[MODULES[-1]].partition('"""\n\n')[0] + '"""'
    bodies = [body(name, text) for name, text in modules.items()]
    return f"{HEAD}{docstring}\n\n{imports(trees.values())}\n\n" + "\n\n\n".join(bodies) + "\n"
