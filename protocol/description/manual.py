"""The manual page racebeam-protocol(7)."""

import re

PATH = "protocol/racebeam-protocol.7"
HEAD = r""".\" Made from protocol/protocol.toml by protocol/description/generate. Do not change it by hand.
.TH RACEBEAM-PROTOCOL 7 "" "racebeam {since}"
.SH NAME
racebeam\-protocol \- the line protocol between racebeam and its clients, version {version}
.SH DESCRIPTION
A client sends requests, and the server answers each with a reply. Both are lines of printable ASCII.
A request is a command and its words, separated by blanks. A reply is
.BR ok ,
followed by pairs
.IR KEY = VALUE ,
or
.BR error ,
followed by a code and a sentence.
.PP
In a synopsis,
.I A|B
is a choice,
.I [...]
is optional, and
.I ...
means repetition. The command
.B help
explains a word of this page on a server.
"""
TAIL = r""".SH SEE ALSO
.BR racebeam (1),
.BR racebeam\-serve (1),
.BR racebeam\-connect (1)
.PP
protocol/PROTOCOL.md of the sources has the protocol in full, with conversations.
"""


def roff(text):
    """Text as it is, for man. Words between ` are bold."""
    text = text.replace("\\", r"\e").replace("-", r"\-")
    return re.sub(r"`([^`]*)`", r"\\fB\1\\fR", re.sub(r"^([.'])", r"\\&\1", text))


def entry(head, *lines):
    """A word, and what it is. Each line after the first is a paragraph of its own."""
    return f".TP\n.B {roff(head)}\n" + "\n.br\n".join(roff(line) for line in lines if line) + "\n"


def section(title, entries):
    return f".SH {title}\n" + "".join(entries)


def current(rows):
    """The rows that are not deprecated."""
    return [row for row in rows if not row.deprecated]


def meanings(choices):
    return [f"`{value}`: {meaning}" for value, meaning in choices.items()]


def about(argument):
    """A pair of a command, and its values, as lines."""
    if argument.choices_of:
        return [f"`{argument.key}`: {argument.about}, as the setting of `load`"]
    if argument.choices:
        return [f"`{argument.key}`: {argument.about}", *meanings(argument.choices)]
    return [f"`{argument.key}`: {argument.about}"] if argument.about else []


def command(row):
    details = [line for argument in row.keys for line in about(argument)]
    replied = ", ".join(key.removesuffix("?") for key in row.reply)
    return entry(
        f"{row.name} {row.usage}".rstrip(),
        row.summary_text,
        row.hint,
        *details,
        f"reply: {replied}" if replied else "",
        f"of each group: {', '.join(key.removesuffix('?') for key in row.groups)}" if row.groups else "",
        f"example: {row.example}" if row.example else "",
    )


def setting(row):
    values = f"values: {row.accepted}; default: {row.default}"
    return entry(f"{row.name}=", row.summary_text, values, *meanings(row.choices))


def field(row):
    encoding = f"bytes; without an encoding as {row.encoding}" if row.encoding else ""
    return entry(row.name, row.summary_text, encoding)


def old(word):
    now = ", ".join(f"`{one}`" for one in word.now.split())
    return entry(word.old, f"{'a field' if word.of == 'field' else f'of `{word.of}`'}; now {now}")


def page(protocol):
    settings, presets = current(protocol.settings), current(protocol.presets)
    return (
        HEAD.replace("{since}", protocol.since).replace("{version}", str(protocol.version))
        + section("COMMANDS", map(command, current(protocol.commands)))
        + section("SETTINGS OF LOAD", map(setting, settings))
        + section("PRESETS", (entry(row.name, row.summary_text, row.sets) for row in presets))
        + section("FIELDS", map(field, current(protocol.fields)))
        + section("ENCODINGS", (entry(row.name, row.summary_text) for row in current(protocol.encodings)))
        + section("ERRORS", (entry(row.code, row.summary_text) for row in current(protocol.errors)))
        + section("OLD WORDS", map(old, protocol.old_words))
        + TAIL
    )


def files(protocol, _):
    return {PATH: page(protocol)}
