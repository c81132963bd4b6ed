"""Parts of files that are generated, where a person writes the rest. They stand between two lines of comment."""


def with_region(text, indent, comment, name, body):
    """The text of a file with the region of that name replaced. Its lines are indented as `indent` says."""
    head = f"{indent}{comment} generated: {name}, from protocol/protocol.toml\n"
    tail = f"{indent}{comment} end of {name}\n"
    if text.count(head) != 1 or text.count(tail) != 1:
        raise ValueError(f"the file has no region {name}: a line {head.strip()!r}, and later a line {tail.strip()!r}")
    begin, end = text.index(head) + len(head), text.index(tail)
    return text[:begin] + body + text[end:]
