"""What a run refuses."""


class BadInput(Exception):
    """Input that cannot be evaluated. The message is one sentence: what is wrong, the value, and what is accepted."""


def printable(text: str) -> str:
    """The text with escapes in place of letters that do not print, such as those that move a terminal's cursor."""
    return "".join(letter if letter.isprintable() else repr(letter)[1:-1] for letter in text)
