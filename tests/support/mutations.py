"""Small edits of a source in C++, each of which makes another program: what a test should notice."""

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
NUMBER = re.compile(r"(?<![\w.\"'])(\d+)(?=[UuLl]*\b)(?![\w.]*[.'xX])")
STATEMENT = re.compile(
    r"^\s+(?!return\b|break\b|continue\b|case\b|default\b|using\b|throw\b|else\b|goto\b)"
    r"(?:\+\+|--)?[\w:]+(?:(?:\.|->)\w+|\[[^]]*\])*(?:\s(?:[-+*/|&^]|<<|>>)?=\s.*|\(.*\)|\+\+|--)?;$"
)
PAIR = re.compile(r"(?<=\()(\w+(?:[.:>-]+\w+)*), (\w+(?:[.:>-]+\w+)*)(?=\))")
NO_CODE = re.compile(r"^\s*(#|//|static_assert|template|namespace|using|friend|\}|public:|private:|$)")
TEXT = re.compile(r'"(?:[^"\\]|\\.)*"|//.*$')


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


def blanked(line):
    """The line with blanks in place of texts and comments, so that a pattern finds only code."""
    return TEXT.sub(lambda found: "_" * len(found[0]), line)


def edits_of(line):
    """What the line may become."""
    code = blanked(line)
    for pattern, other in EDITS:
        for found in re.finditer(pattern, code):
            yield line[: found.start()] + other + line[found.end() :]
    for found in NUMBER.finditer(code):
        yield line[: found.start()] + str(int(found[1]) + 1) + line[found.end(1) :]
    for found in PAIR.finditer(code):
        if found[1] != found[2]:
            yield line[: found.start()] + f"{found[2]}, {found[1]}" + line[found.end() :]
    if STATEMENT.match(code):
        yield ""


def mutants(source):
    """All mutants of a source, in the order of its lines."""
    return [
        Mutant(number, line, after)
        for number, line in enumerate(source.split("\n"), 1)
        if not NO_CODE.match(line)
        for after in dict.fromkeys(edits_of(line))
        if after != line
    ]
