"""One table in three forms: Markdown, LaTeX and CSV. Each names the digests of the files that it was made from."""

import csv
import dataclasses
import io

import pandas as pd

from ..csv_file import Source

_NOT_AVAILABLE = "n/a"


def _escapes(letters: str) -> dict[int, str]:
    return str.maketrans({letter: f"\\{letter}" for letter in letters})


# Names of agents are those of the results, which may be another's.
_LATEX = _escapes("&%_#${}") | str.maketrans(
    {"\\": r"\textbackslash{}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}"}
)
_MARKDOWN = _escapes("|<")


@dataclasses.dataclass(frozen=True)
class Table:
    """Rows under headings. A cell that is NaN is not available."""

    name: str  # of the files, without ending
    caption: str  # a sentence
    frame: pd.DataFrame
    sources: tuple[Source, ...]
    notes: tuple[str, ...] = ()  # sentences that stand below the table
    digits: int = 3  # after the point, in Markdown and LaTeX; CSV has them all
    best_of: tuple[str, ...] = ()  # columns; the highest number of a row is printed in bold

    def files(self) -> dict[str, str]:
        """The three forms by file name."""
        return {f"{self.name}.csv": self.csv(), f"{self.name}.md": self.markdown(), f"{self.name}.tex": self.latex()}

    def csv(self) -> str:
        """The digests as comments, the headings, and a line for each row."""
        text = io.StringIO()
        text.writelines(f"# {line}\n" for line in made_from(self.sources))
        csv.writer(text, lineterminator="\n").writerows(
            [list(self.frame), *(map(_exact, row) for row in self._cells())]
        )
        return text.getvalue()

    def markdown(self) -> str:
        """The caption, the table, the notes, and the digests as comments."""
        marks = ["---:" if pd.api.types.is_numeric_dtype(self.frame[name]) else "---" for name in self.frame]
        lines = [[str(name).translate(_MARKDOWN) for name in self.frame], marks, *self._texts("**{}**", _MARKDOWN)]
        below = [line for note in self.notes for line in (note, "")]
        comments = [f"<!-- {line} -->" for line in made_from(self.sources)]
        return "\n".join([self.caption, "", *(f"| {' | '.join(line)} |" for line in lines), "", *below, *comments, ""])

    def latex(self) -> str:
        """A tabular that needs the package booktabs. Caption, notes and digests are comments."""
        columns = ["r" if pd.api.types.is_numeric_dtype(self.frame[name]) else "l" for name in self.frame]
        comments = [f"% {line}" for line in (self.caption, *self.notes, *made_from(self.sources))]
        header, *rows = [
            " & ".join(line) + r" \\"
            for line in ([str(name).translate(_LATEX) for name in self.frame], *self._texts(r"\textbf{{{}}}", _LATEX))
        ]
        return "\n".join(
            [
                *comments,
                rf"\begin{{tabular}}{{{''.join(columns)}}}",
                r"\toprule",
                header,
                r"\midrule",
                *rows,
                r"\bottomrule",
                r"\end{tabular}",
                "",
            ]
        )

    def _cells(self) -> list[tuple[object, ...]]:
        return list(self.frame.itertuples(index=False, name=None))

    def _texts(self, bold: str, escapes: dict[int, str]) -> list[list[str]]:
        """The cells as text for readers. bold: the format of the best one; escapes: of letters that have a meaning."""
        best = self.frame[list(self.best_of)].max(axis=1).tolist() if self.best_of else [None] * len(self.frame)
        rows = []
        for row, highest in zip(self._cells(), best):
            texts = [_rounded(cell, self.digits).translate(escapes) for cell in row]
            rows.append(
                [
                    bold.format(text) if name in self.best_of and cell == highest else text
                    for name, cell, text in zip(self.frame, row, texts)
                ]
            )
        return rows


def made_from(sources: tuple[Source, ...]) -> list[str]:
    """The line on each source, by which `racebeam verify` finds whether a table is that of its results."""
    return [f"made from {source.name} sha256:{source.sha256}" for source in sources]


def _exact(cell: object) -> str:
    if isinstance(cell, float):
        return _NOT_AVAILABLE if cell != cell else f"{cell:.12g}"
    return str(cell)


def _rounded(cell: object, digits: int) -> str:
    if isinstance(cell, float):
        return _NOT_AVAILABLE if cell != cell else f"{round(cell, digits) + 0.0:.{digits}f}"
    return str(cell)
