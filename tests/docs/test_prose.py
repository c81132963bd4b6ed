"""Comments, messages and documents avoid forms that hide who does what. CONTRIBUTING.md, "Prose", has the rules."""

import re
import unittest

from tree import ROOT, files

ENDINGS = {".cpp", ".hpp", ".py", ".md", ".toml", ".java", ".js", ".lua", ".ts", ".bash"}
NOT_READ = ("CHANGELOG.md", "docs/spec/", "viewer/dist/", "tests/docs/test_prose.py")
FORBIDDEN = {
    r"\b(?:is|are|was|were) none\b": "say what does not exist, or what lacks it",
    r"\bhas none\b": "name what it lacks",
    r"\baccepted are\b": "errors end with 'accepted: A, B'",
    r"[\"'`](?:[^\"'`]*[:;] )?there (?:is|are) no (?:\w+ )?[\"'{]": "errors begin with 'unknown KIND'",
    r"\b(?:def|self\.|auto|void) ?_?\w*_(?:told|shown|meant|begun)\b(?!\w)": "a name is a noun or a verb",
}


def faults(path, text):
    """A line for each forbidden form in a text."""
    for number, line in enumerate(text.splitlines(), 1):
        for form, advice in FORBIDDEN.items():
            if re.search(form, line) and "def test_" not in line:
                yield f"{path}:{number}: {line.strip()[:100]} ({advice})"


class Prose(unittest.TestCase):
    def test_this_tree_has_no_forbidden_form(self):
        wrong = []
        for path in files():
            name = path.as_posix()
            if (path.suffix in ENDINGS or name.startswith("scripts/")) and not name.startswith(NOT_READ):
                wrong += faults(name, (ROOT / path).read_text(errors="replace"))
        self.assertEqual(wrong, [], "\n".join(wrong))

    def test_each_form_is_found(self):
        for line in (
            "// null if there is none",
            "# an empty text has none",
            '"; accepted are a and b"',
            'raise Error(f"there is no game {game!r}")',
            "def _game_shown(self):",
        ):
            self.assertEqual(len(list(faults("a", line))), 1, line)
        self.assertEqual(list(faults("a", "\"unknown game 'x'; accepted: a, b\"")), [])


if __name__ == "__main__":
    unittest.main()
