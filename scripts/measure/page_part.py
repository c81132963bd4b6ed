"""Replaces the part of a document that a script writes. It lies between a comment that names the script, and
`<!-- end -->`.

usage: page_part.py PAGE SCRIPT <PART
"""

import pathlib
import sys

END = "<!-- end -->"


def begin(script):
    """The line before the part of a script, such as "scripts/bench core"."""
    return f"<!-- {script} --write: begin -->\n"


def replace(page, script, part):
    """Replaces the part that `script` writes.

    Args:
        page: the path of the document.
        script: as the document names it, without `--write`.
        part: the new text, which ends with a newline.

    Raises OSError if the document lacks one of the comments. It is then as it was.
    """
    before, first, rest = page.read_text().partition(begin(script))
    _, last, after = rest.partition(END)
    if not (first and last):
        raise OSError(f"{page} lacks the lines {begin(script).rstrip()} and {END}; expected both")
    page.write_text(before + first + part + last + after)


if __name__ == "__main__":
    try:
        replace(pathlib.Path(sys.argv[1]), sys.argv[2], sys.stdin.read())
    except OSError as error:
        sys.exit(f"page_part.py: {error}")
