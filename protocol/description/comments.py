"""Comments of generated code."""

import textwrap

COLUMNS = 110


def comment_lines(prefix, *paragraphs):
    """The lines of a comment. Each paragraph begins a line; a tag such as @param indents what continues it."""
    for text in paragraphs:
        indent = "    " if text.startswith("@") else ""
        yield from textwrap.wrap(
            text,
            COLUMNS,
            initial_indent=prefix,
            subsequent_indent=prefix + indent,
            break_long_words=False,
            break_on_hyphens=False,
        )


def about_number(argument):
    """The description of an argument whose parameter is a number, and so cannot be the word random."""
    return argument.about.removesuffix(", or random")
