"""Comments, messages and documents avoid forms that hide who does what. CONTRIBUTING.md, "Prose", has the rules."""

import re

from tree import ROOT, files

ENDINGS = {".cpp", ".hpp", ".py", ".md", ".toml", ".java", ".js", ".lua", ".ts", ".bash"}
NOT_READ = ("CHANGELOG.md", "docs/spec/", "viewer/dist/", "tests/docs/test_prose.py")
PARTICIPLE = r"(?:told|said|meant|asked|heard|wanted|begun)"
NAME = "a name is a noun or a verb"
FORBIDDEN = {
    r"\b(?:is|are|was|were) none\b": "say what does not exist, or what lacks it",
    r"\bhas none\b": "name what it lacks",
    r"\bhelp=\"(?:of|as|that) ": "a help text begins with what the option sets",
    r"(?:^|[.] |// |# |\"\"\")Else[ ,]": "a sentence does not begin with 'Else': 'Otherwise'",
    r"\baccepted are\b": "errors end with 'accepted: A, B'",
    r"[\"'`](?:[^\"'`]*[:;] )?there (?:is|are) no (?:\w+ )?[\"'{]": "errors begin with 'unknown KIND'",
    r"(?<!there )(?<!There )\b(?:is|are|was|were) no (?!longer|more|less|later|fewer)\w": "negate the verb: 'is not'",
    r"^\s*(?://+|#|--|\"\"\") ?(?:Of|Those|The same|As(?! long| soon| far))\b[^,:;]*$": "a sentence has its subject",
    r"\b(?:def|self\.|auto|void) ?_?\w*_(?:told|shown|meant|begun)\b(?!\w)": NAME,
    rf"(?:^\s*|^\s*for .*\b)(?:\w+, )*{PARTICIPLE}(?:, \w+)*(?: = | in )": NAME,
    rf"^\s*(?:const )?[\w:<>]+[&*]? {PARTICIPLE}_?(?: = |;|\{{)": NAME,
    rf"(?:[\[(,] ?|\{{ )(?:const [\w:]+& )?\*?{PARTICIPLE}(?: ?[\]}})]|, |:)": NAME,
}
TESTS = r"(?:TEST_CASE\(\"|\btest\(\"|def test_)"
FORBIDDEN_IN_TESTS = {
    rf"{TESTS}.*[ _]none(?![a-z]|[ _]of[ _])": "say what does not exist, or what lacks it",
    rf"{TESTS}.*(?<!there)[ _](?:is|are)[ _]no[ _](?!longer)": "negate the verb: 'is not'",
    rf"{TESTS}.*[ _](?:is|are)[ _](?:told|said|content)(?![a-z]|[ _](?:to|apart|by|from)[ _\"(])": (
        "say what is reported"
    ),
}
# Each form has one of these words. Most lines have none of them, and are done.
WORDS = re.compile(
    rf"none|help=|Else|accepted are|shown|content|(?<![a-z])no(?![a-z])|\b(?:As|Of|Those|The same)\b|{PARTICIPLE}"
)


def faults(path, text):
    """A line for each forbidden form in a text."""
    for number, line in enumerate(text.splitlines(), 1):
        if not WORDS.search(line):
            continue
        forms = FORBIDDEN_IN_TESTS if re.search(TESTS, line) else FORBIDDEN
        for form, advice in forms.items():
            if re.search(form, line):
                yield f"{path}:{number}: {line.strip()[:100]} ({advice})"


class TestProse:
    def test_this_tree_has_no_forbidden_form(self):
        wrong = []
        for path in files():
            name = path.as_posix()
            if (path.suffix in ENDINGS or name.startswith("scripts/")) and not name.startswith(NOT_READ):
                wrong += faults(name, (ROOT / path).read_text(errors="replace"))
        assert wrong == [], "\n".join(wrong)

    def test_each_form_is_found(self):
        for line in (
            "// null if there is none",
            "# an empty text has none",
            '"; accepted are a and b"',
            'parser.add_argument("--steps", help="of each run")',
            "# Else restarts the program.",
            'raise Error(f"there is no game {game!r}")',
            "def _game_shown(self):",
            "        told = subprocess.run(command)",
            "    for words, said in cases:",
            "  const std::string meant = did_you_mean(name);",
            '    const [name, told] = field.split(":");',
            "    def check(self, script, *said, **variables):",
            "// an image that is no cartridge",
            '    """Of all units."""',
            "  // The same for a watched session.",
            "    def test_counts_that_are_none(self):",
            'TEST_CASE("a folder is no image") {',
            "    def test_mypy_is_content(self):",
        ):
            assert len(list(faults("a", line))) == 1, line
        for line in (
            "\"unknown game 'x'; accepted: a, b\"",
            "// Lines for which there is no room wait here.",
            'parser.add_argument("--steps", help="steps per run")',
            "# As long as the server runs, the file stays.",
            "if told in words:",
            'TEST_CASE("Without news there is no picture") {',
            'TEST_CASE("A request is over only if none of its acts was played") {',
            "    def test_machines_are_told_apart(self):",
        ):
            assert list(faults("a", line)) == [], line
