"""Each `pip install` of the tree names a folder or a package that pip can install."""

import importlib.util
import re
import shlex

import tomllib
import tree

# It does not match the lines of scripts, which call pip as a module, nor words such as "pip installs".
COMMAND = re.compile(r"""(?<!-m )\bpip install((?: +(?:"[^"\n{]+"|[A-Za-z.][\w.,\[\]<>=/-]*))+)""")
NAME = re.compile(r"[\w-]+")
# Packages of examples, which are on PyPI.
OTHERS = {"envpool", "gymnasium", "matplotlib", "moviepy", "optax", "tianshou", "torch", "torchrl", "tqdm"}
HERE = tree.ROOT / "tests/docs/test_install_lines.py"


def extras(folder):
    """The extras of a folder's package, with their requirements."""
    return tomllib.loads((folder / "pyproject.toml").read_text())["project"].get("optional-dependencies", {})


def commands(text):
    """The words after `pip install` of each command in a text, which may be a notebook."""
    for found in COMMAND.finditer(text.replace('\\"', '"')):
        yield shlex.split(found[1])


def fault(word):
    """What is wrong with a word of a command, or None."""
    folder, _, rest = word.partition("[")
    if not folder.startswith("."):
        return None if NAME.match(word)[0] in packages() | OTHERS else "is neither a folder nor the package of an extra"
    if not (tree.ROOT / folder / "pyproject.toml").exists():
        return "is a folder without pyproject.toml"
    unknown = set(filter(None, rest.rstrip("]").split(","))) - set(extras(tree.ROOT / folder))
    return f"names extras that pyproject.toml lacks: {', '.join(sorted(unknown))}" if unknown else None


def packages():
    """Names of the packages that the extras bring, without racebeam itself, which no index has."""
    requirements = (requirement for extra in extras(tree.ROOT).values() for requirement in extra)
    return {NAME.match(requirement)[0] for requirement in requirements} - {"racebeam"}


class TestInstallLines:
    def test_the_check_refuses_what_pip_cannot_install(self):
        for word in ("racebeam", "racebeam[jax]", "./clients/python", ".[unknown]", "./evaluation[jax]"):
            assert fault(word) is not None, word
        for word in (".", ".[jax]", ".[jax,human]", "./evaluation", "gymnasium>=1.1", "dm-env"):
            assert fault(word) is None, word

    def test_each_line_of_the_tree_works(self):
        wrong, count = [], 0
        for path in tree.files():
            if path.suffix not in {".md", ".py", ".ipynb"} or tree.ROOT / path == HERE:
                continue
            for command in commands((tree.ROOT / path).read_text()):
                count += 1
                wrong += [f"{path}: {word} {fault(word)}" for word in command if fault(word)]
        assert not wrong, "\n".join(wrong)
        assert count > 10

    def test_the_hints_of_errors_are_the_requirements_of_the_extras(self):
        spec = importlib.util.spec_from_file_location("extras", tree.ROOT / "clients/python/racebeam/extras.py")
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        required = {requirement.partition(";")[0] for extra in extras(tree.ROOT).values() for requirement in extra}
        for requirement in module.REQUIREMENTS.values():
            if requirement.startswith("."):
                assert fault(requirement) is None, requirement
            else:
                assert requirement in required
        for name, requirement in module.REQUIREMENTS.items():
            assert module.install_hint(name) == f'install it with: pip install "{requirement}"'
