"""Numbers in README.md, clients/README.md and docs/python/ are those of what they describe."""

import ast
import re
import sys
import unittest

import tomllib
from test_figures import last_run
from tree import ROOT

sys.path.insert(0, str(ROOT / "clients/conformance"))
import clients  # noqa: E402

MOST_WRONG = 0.03  # part of a count of lines, which changes with each change of a client
HEADINGS = {"Python": "python", "Java": "java", "Lua": "lua", "C++20,": "cpp", "JavaScript,": "js", "bash": "shell"}


def page(path):
    return (ROOT / path).read_text()


def table(text, heading):
    """The rows of the table with this heading, as lists of cells."""
    lines = text[text.index(heading) :].split("\n\n")[0].splitlines()[2:]
    return [[cell.strip() for cell in line.strip("| ").split("|")] for line in lines]


class Numbers(unittest.TestCase):
    def test_the_title_of_the_readme_rounds_the_speed_of_the_last_run(self):
        means, _, _ = last_run()
        [listed] = re.findall(r"\(ALE\), (\d+) times as\s+fast", page("README.md"))
        self.assertEqual(int(listed), int(means["Screen of every frame"]))

    def test_the_readme_names_the_packages_of_this_version(self):
        [version] = re.findall(r"project\(racebeam VERSION ([0-9.]+)", page("CMakeLists.txt"))
        versions = re.findall(r"racebeam-(\d+\.\d+\.\d+)", page("README.md"))
        self.assertEqual(set(versions), {version})

    def test_clients_have_about_as_many_lines_as_their_page_says(self):
        lines = {client.language: client.lines_of_code() for client in clients.CLIENTS}
        rows = table(page("clients/README.md"), "| language | connects over |")
        self.assertEqual(len(rows), len(HEADINGS))
        for name, *_, claim in rows:
            count = lines[HEADINGS[name.split()[0]]]
            self.assertLess(
                abs(int(claim) - count), MOST_WRONG * count, f"{name}: scripts/clients counts {count} lines"
            )

    def test_the_python_page_names_the_extras_and_the_oldest_versions(self):
        project = tomllib.loads(page("pyproject.toml"))["project"]
        text = " ".join(page("docs/python/reference.md").split())
        [listed] = re.findall(r"Each of the extras (.*?) brings", text)
        self.assertEqual(set(re.findall(r"`([\w-]+)`", listed)), set(project["optional-dependencies"]))
        python = project["requires-python"].removeprefix(">=")
        self.assertIn(f"runs on Linux with Python {python} or later", text)
        gymnasium = re.search(r"gymnasium>=([\d.]+)", project["optional-dependencies"]["gymnasium"][0])[1]
        self.assertIn(f"brings Gymnasium {gymnasium} or later", text)

    def test_the_python_page_has_the_limits_of_vectors(self):
        source = ast.parse(page("clients/python/racebeam/vector_options.py"))
        [limits] = (
            node.value
            for node in source.body
            if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "INTEGERS"
        )
        limits = {key.value: ast.unparse(value) for key, value in zip(limits.keys, limits.values)}
        figures = {
            name.strip("`"): takes for name, takes in table(page("docs/python/reference.md"), "| argument | takes |")
        }
        for name in ("stack_num", "noop_max", "frameskip"):
            self.assertEqual(figures[name].replace(" to ", ", "), limits[name].strip("()"))


if __name__ == "__main__":
    unittest.main()
