"""Small edits of a source in C++ or Python, each of which makes another program: what a test should notice."""

import ast
import dataclasses
import re

# A pattern, and what it becomes. Each match in the code of a line is an edit of its own.
EDITS = (
    (r"\s<\s", " <= "),
    (r"\s<=\s", " < "),
    (r"\s>\s", " >= "),
    (r"\s>=\s", " > "),
    (r"\s==\s", " != "),
    (r"\s!=\s", " == "),
    (r"\s&&\s", " || "),
    (r"\s\|\|\s", " && "),
    (r"(?<=[\w)\]])\s\+\s(?=[\w(])", " - "),
    (r"(?<=[\w)\]])\s-\s(?=[\w(])", " + "),
    (r"(?<=[\w)\]])\s\*\s(?=[\w(])", " + "),
    (r"\s\+=\s", " -= "),
    (r"\s-=\s", " += "),
    (r"\btrue\b", "false"),
    (r"\bfalse\b", "true"),
    (r"(?<=[(\s])!(?=[\w(])", ""),
    (r"\bstd::min\b", "std::max"),
    (r"\bstd::max\b", "std::min"),
    (r"\bany_of\b", "all_of"),
    (r"\bfirst\b(?=\()", "last"),
)
PYTHON_EDITS = (
    *EDITS,
    (r"\sand\s", " or "),
    (r"\sor\s", " and "),
    (r"\bnot\s(?!in\b)", ""),
    (r"\snot\sin\s", " in "),
    (r"\bTrue\b", "False"),
    (r"\bFalse\b", "True"),
    (r"\bmin\b(?=\()", "max"),
    (r"\bmax\b(?=\()", "min"),
    (r"\bany\b(?=\()", "all"),
    (r"\ball\b(?=\()", "any"),
    (r"\s/\s", " * "),
)
NUMBER = re.compile(r"(?<![\w.\"'])(\d+)(?=[UuLl]*\b)(?![\w.]*[.'xX])")
STATEMENT = re.compile(
    r"^\s+(?!return\b|break\b|continue\b|case\b|default\b|using\b|throw\b|else\b|goto\b)"
    r"(?:\+\+|--)?[\w:]+(?:(?:\.|->)\w+|\[[^]]*\])*(?:\s(?:[-+*/|&^]|<<|>>)?=\s.*|\(.*\)|\+\+|--)?;$"
)
PAIR = re.compile(r"(?<=\()(\w+(?:[.:>-]+\w+)*), (\w+(?:[.:>-]+\w+)*)(?=\))")
NO_CODE = re.compile(r"^\s*(#|//|static_assert|template|namespace|using|friend|\}|public:|private:|$)")
TEXT = re.compile(r'"(?:[^"\\]|\\.)*"|//.*$')
PYTHON_STATEMENT = re.compile(
    r"^\s+(?!return\b|raise\b|yield\b|assert\b)"
    r"(?:(?:\w+(?:\.\w+)+|[\w.]+\[[^]]*\])\s=\s.*[^([{,]|[\w.]+(?:\[[^]]*\])?\s[-+*/|&]=\s.*[^([{,]|[\w.]+\(.*\))$"
)
PYTHON_NO_CODE = re.compile(r"^\s*(#|import\b|from\b|@|class\b|$)")
PYTHON_TEXT = re.compile(r'"(?:[^"\\]|\\.)*"|#.*$')


@dataclasses.dataclass(frozen=True)
class Mutant:
    line: int  # from 1
    before: str
    after: str

    def apply(self, source):
        lines = source.split("\n")
        assert lines[self.line - 1] == self.before
        lines[self.line - 1] = self.after
        return "\n".join(lines)

    def __str__(self):
        return f"{self.line}: {self.before.strip()}\n    {self.after.strip() or '(nothing)'}"


@dataclasses.dataclass(frozen=True)
class Language:
    """How a line of a language is read."""

    edits: tuple[tuple[str, str], ...]
    text: re.Pattern  # texts and comments
    statement: re.Pattern  # what can be dropped
    no_code: re.Pattern
    nothing: str  # what stands in place of a statement; {} is its indentation


CPP = Language(EDITS, TEXT, STATEMENT, NO_CODE, "")
PYTHON = Language(PYTHON_EDITS, PYTHON_TEXT, PYTHON_STATEMENT, PYTHON_NO_CODE, "{}pass")


def blanked(line, language):
    """The line with blanks in place of texts and comments, so that a pattern finds only code."""
    return language.text.sub(lambda found: "_" * len(found[0]), line)


def edits_of(line, language=CPP):
    """What the line may become."""
    code = blanked(line, language)
    for pattern, other in language.edits:
        for found in re.finditer(pattern, code):
            yield line[: found.start()] + other + line[found.end() :]
    for found in NUMBER.finditer(code):
        yield line[: found.start()] + str(int(found[1]) + 1) + line[found.end(1) :]
    for found in PAIR.finditer(code):
        first, second = (line[slice(*found.span(number))] for number in (1, 2))
        if first != second:
            yield f"{line[: found.start()]}{second}, {first}{line[found.end() :]}"
    if language.statement.match(code):
        yield language.nothing.format(line[: len(line) - len(line.lstrip())])


def docstring_lines(source):
    """The lines of a source in Python that only text occupies."""
    return {
        number
        for node in ast.walk(ast.parse(source))
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)
        for number in range(node.lineno, node.end_lineno + 1)
    }


def raw_text_lines(source):
    """The lines of a source in C++ in which a raw string begins, goes on or ends."""
    skipped = set()
    for found in re.finditer(r'R"([^()\s]*)\(.*?\)\1"', source, re.DOTALL):
        begin = source.count("\n", 0, found.start()) + 1
        skipped.update(range(begin, begin + found.group().count("\n") + 1))
    return skipped


def compiles(source):
    try:
        compile(source, "mutant", "exec")
    except SyntaxError:
        return False
    return True


def mutants(source, language=CPP):
    """All mutants of a source, in the order of its lines. Those in Python compile."""
    skipped = docstring_lines(source) if language is PYTHON else raw_text_lines(source)
    found = [
        Mutant(number, line, after)
        for number, line in enumerate(source.split("\n"), 1)
        if number not in skipped and not language.no_code.match(line)
        for after in dict.fromkeys(edits_of(line, language))
        if after != line
    ]
    return [each for each in found if language is CPP or compiles(each.apply(source))]
