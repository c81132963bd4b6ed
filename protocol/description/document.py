"""The tables of protocol/PROTOCOL.md."""

PATH = "protocol/PROTOCOL.md"


def code(text):
    escaped = text.replace("|", "\\|")
    return f"`{escaped}`"


def row(*cells):
    return "| " + " | ".join(cells) + " |\n"


def current(rows):
    """The rows that are not deprecated."""
    return [one for one in rows if not one.deprecated]


def choices(protocol, command, *keys):
    """The keys of a command, and the values that they may have, with their meanings."""
    arguments = next(one.arguments for one in protocol.commands if one.name == command)
    return [
        (argument.key, value, meaning)
        for argument in arguments
        if argument.key in keys
        for value, meaning in argument.choices.items()
    ]


def setting_choices(protocol, name):
    """The values of a setting, with their meanings."""
    values = next(one.choices for one in protocol.settings if one.name == name)
    return [row(code(value), meaning) for value, meaning in values.items()]


def old_words(protocol):
    """The old words, with what to write instead."""
    for word in protocol.old_words:
        where = "a field" if word.of == "field" else code(word.of)
        yield row(where, code(word.old), ", ".join(code(now) for now in word.now.split()))


def joystick_rows(names):
    """The numbers and names of actions, in three columns."""
    third = len(names) // 3
    numbered = [f"{number} | {name}" for number, name in enumerate(names)]
    return [row(*cells) for cells in zip(numbered[:third], numbered[third:-third], numbered[-third:], strict=True)]


def console_rows(protocol):
    first = len(protocol.joystick)
    return [row(str(first + place), name, effect) for place, (name, effect) in enumerate(protocol.console.items())]


def tables(protocol):
    """The rows of each table, by the line of its headings."""
    return {
        "| command | what it does |": [
            row(code(f"{command.name} {command.usage}".rstrip()), command.summary_text)
            for command in current(protocol.commands)
        ],
        "| setting | values | default | meaning |": [
            row(code(one.name), one.accepted, one.default, one.summary_text) for one in current(protocol.settings)
        ],
        "| preset | sets | source |": [
            row(code(one.name), code(one.sets), one.summary_text) for one in current(protocol.presets)
        ],
        "| field | content | encoding |": [
            row(code(one.name), one.summary_text, one.encoding) for one in current(protocol.fields)
        ],
        "| encoding | form |": [row(code(one.name), one.summary_text) for one in current(protocol.encodings)],
        "| autoreset | at the end of an episode |": setting_choices(protocol, "autoreset"),
        "| life_loss | a lost life |": setting_choices(protocol, "life_loss"),
        "| of | old | now |": list(old_words(protocol)),
        "| key | value | meaning |": [
            row(code(key), code(value), meaning)
            for key, value, meaning in choices(protocol, "open", "start", "stack", "pool")
        ],
        "| number | name | number | name | number | name |": joystick_rows(protocol.joystick),
        "| number | name | effect |": console_rows(protocol),
        "| action_set | actions |": setting_choices(protocol, "action_set"),
        "| code | meaning |": [row(code(one.code), one.summary_text) for one in current(protocol.errors)],
    }


def with_table(text, head, rows):
    """The document, with the table under this line of headings replaced."""
    begin = text.index(f"{head}\n|---")
    first = text.index("\n", begin + len(head) + 1) + 1
    end = text.find("\n\n", first)
    return text[:first] + "".join(rows) + (text[end + 1 :] if end >= 0 else "")


def files(protocol, read):
    text = read(PATH)
    for head, rows in tables(protocol).items():
        text = with_table(text, head, rows)
    return {PATH: text}
