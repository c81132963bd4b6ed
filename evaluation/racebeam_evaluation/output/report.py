"""A report: tables and pictures in an order, written as files with a Markdown document that shows them."""

import dataclasses

from ..csv_file import Source
from .figure import Picture
from .table import Table, made_from

_MOST_ROWS = 120  # of a table that the document shows; it links to a longer one


@dataclasses.dataclass
class Report:
    """What a run writes."""

    title: str
    introduction: list[str]  # sentences
    sources: tuple[Source, ...]
    parts: list[Table | Picture] = dataclasses.field(default_factory=list)
    untested: list[str] = dataclasses.field(default_factory=list)  # sentences on tests that could not be made

    def add_table(self, table: Table) -> None:
        """Adds the table unless it is empty."""
        if len(table.frame):
            self.parts.append(table)

    def files(self) -> dict[str, bytes]:
        """All files by their paths in the folder."""
        files = {"report.md": self.document().encode()}
        for part in self.parts:
            if isinstance(part, Table):
                files |= {f"tables/{name}": text.encode() for name, text in part.files().items()}
            else:
                files |= {f"figures/{name}": content for name, content in part.files().items()}
        return files

    def document(self) -> str:
        """The report in Markdown, which shows the tables and the figures."""
        sections = [f"# {self.title}", " ".join(self.introduction), *self.untested]
        sections += ["\n".join(f"- {line}" for line in made_from(self.sources))] if self.sources else []
        for part in self.parts:
            sections += [f"## {'Table' if isinstance(part, Table) else 'Figure'} {part.name}", self._lines_of(part)]
        return "\n\n".join(section.rstrip("\n") for section in sections if section) + "\n"

    @staticmethod
    def _lines_of(part: Table | Picture) -> str:
        if isinstance(part, Picture):
            return f"{part.caption}\n\n![{part.caption}](figures/{part.name}.svg)"
        if len(part.frame) > _MOST_ROWS:
            return f"{part.caption}\n\n[{len(part.frame)} rows](tables/{part.name}.csv)"
        return part.markdown()
