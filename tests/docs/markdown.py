"""The Markdown that the tests of documents understand: headings and their anchors, links, tables,
paragraphs."""

import dataclasses
import re


@dataclasses.dataclass
class Section:
    heading: str  # without its marks, as in "4. Register access procedure"
    lines: list  # what stands below it, up to the next heading of any level

    def number(self):
        """The number that the heading begins with, or None."""
        numbered = re.match(r"(\d+)\. ", self.heading)
        return int(numbered[1]) if numbered else None

    def cases(self):
        """The numbers in the first column of the section's tables."""
        rows = [re.match(r"\|\s*(\d+)\s*\|", line) for line in self.lines]
        return {int(row[1]) for row in rows if row}


def prose(text):
    """(line number, line) of all lines outside fenced and indented code."""
    fenced = False
    for number, line in enumerate(text.splitlines(), 1):
        if line.lstrip().startswith("```"):
            fenced = not fenced
        elif not fenced and not line.startswith("    "):
            yield number, line


def sections(text):
    found = []
    for _, line in prose(text):
        heading = re.match(r"#+ (.*)", line)
        if heading:
            found.append(Section(heading[1].strip(), []))
        elif found:
            found[-1].lines.append(line)
    return found


def anchor(heading):
    """The anchor of a heading on the usual forges: lower case, hyphens for blanks, no punctuation."""
    text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).lower()
    return re.sub(r"[^\w\- ]", "", text).replace(" ", "-")


def anchors(text):
    """All anchors of a document. The second heading of the same name gets `-1`, and so on."""
    found, counts = set(), {}
    for section in sections(text):
        name = anchor(section.heading)
        found.add(f"{name}-{counts[name]}" if name in counts else name)
        counts[name] = counts.get(name, 0) + 1
    return found


def links(text):
    """(line number, target) of each link and picture. The text of a link may continue in the next line."""
    lines = {number: re.sub(r"`[^`]*`", "", line) for number, line in prose(text)}
    whole = "\n".join(lines.get(number, "") for number in range(1, max(lines, default=0) + 1))
    for link in re.finditer(r"\[[^\]]*\]\(([^)]+)\)", whole):
        yield whole.count("\n", 0, link.end()) + 1, link[1]
