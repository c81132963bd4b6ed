"""The tables and the methods of the client in Python, and the client as a single file."""

import itertools
import textwrap

import python_single_file
from regions import with_region

FOLDER = "clients/python/racebeam/wire"
FIELDS, COMMANDS = f"{FOLDER}/fields.py", f"{FOLDER}/commands.py"
SINGLE_FILE = "clients/python/single_file/client.py"
WIDTH = 120
TYPES = {
    "int": "int",
    "seed": "int | str",
    "flag": "bool | int",
    "text": "str",
    "fields": "str",
    "texts": "str",
    "actions": "object",
}
RETURNS = {
    "first": ("Values", "_first"),
    "groups": ("list[Values]", "_rest"),
    "nothing": ("None", "ask"),
    "list": ("list[str]", "_list_of"),
    "ints": ("list[int]", "_ints_of"),
}


def sentence(text):
    return text[0].upper() + text[1:] + ("" if text.endswith(".") else ".")


def folded(text, indent, hanging=""):
    return textwrap.fill(text, WIDTH, initial_indent=indent, subsequent_indent=indent + hanging) + "\n"


def parameter(argument):
    kind = TYPES[argument.type]
    if argument.is_repeated:
        return f"*{argument.name}: {kind}"
    return f"{argument.name}: {kind} | None = None" if argument.optional else f"{argument.name}: {kind}"


def in_request(argument):
    """The expression that puts a word into the request."""
    if argument.is_repeated:
        return f"*{argument.name}"
    return f"*optional_words({argument.name})" if argument.optional else argument.name


def request_words(command):
    """The expressions of the arguments. Neighbouring pairs go together."""
    for has_key, arguments in itertools.groupby(command.arguments, key=lambda argument: bool(argument.key)):
        if has_key:
            names = [argument.key for argument in arguments] + [argument.key for argument in command.old_keys]
            yield f"*key_values({', '.join(f'{name}={name}' for name in names)})"
        else:
            yield from map(in_request, arguments)


def all_arguments(command):
    return [*command.words, *command.keys, *command.old_keys]


def signature(command, result):
    parameters = ["self", *(parameter(argument) for argument in all_arguments(command))]
    line = f"    def {command.method}({', '.join(parameters)}) -> {result}:\n"
    if len(line) <= WIDTH:
        return line
    return f"    def {command.method}(\n" + "".join(f"        {one},\n" for one in parameters) + f"    ) -> {result}:\n"


def explained(argument):
    """The row of an argument in a docstring."""
    name = f"*{argument.name}" if argument.is_repeated else argument.name
    about = sentence(argument.about) if argument.about else f"`{argument.usage.strip('[]')}` of the request."
    return folded(f"{name}: {about}", " " * 12, "    ")


def listed(names):
    names = [f"`{name}`" for name in names]
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} and {names[-1]}"


def values_of(reply, fields):
    """Says what a dictionary of the reply has."""
    always = [key for key in reply if not key.endswith("?")]
    sometimes = [key.removesuffix("?") for key in reply if key.endswith("?")]
    parts = [fields] if fields else []
    if always:
        parts.append(listed(always))
    if sometimes:
        parts.append(f"{listed(sometimes)} where {'it applies' if len(sometimes) == 1 else 'they apply'}")
    return ", and ".join(parts)


def shown(command, group):
    """The fields that a group has."""
    return {group: "the selected fields", "asked": "these fields"}.get(command.shows, "")


def result_of(command):
    """The sentence of a docstring that says what a method returns."""
    kind, _, key = command.returns.partition(" ")
    if kind in ("list", "ints"):
        return f"The list `{key}` of the reply, as {'texts' if kind == 'list' else 'numbers'}."
    if kind == "groups":
        subject = "A dictionary for each machine" if command.shows else "A dictionary for each session"
        values = values_of(command.groups, shown(command, "groups"))
        return f"{subject}, with {values}."
    settings = ", and each setting" if command.echoes else ""
    values = values_of(command.reply, shown(command, "first"))
    return f"A dictionary with {values}{settings}."


def docstring(command):
    text = folded(f'"""{sentence(command.summary)}', " " * 8)
    if command.arguments:
        text += "\n        Args:\n" + "".join(map(explained, all_arguments(command)))
    if command.returns != "nothing":
        text += "\n        Returns:\n" + folded(result_of(command), " " * 12)
    return text + '        """\n' if "\n\n" in text else text[:-1] + '"""\n'


def argument_line(word):
    """Formats an argument as lines. Splits a call that is too long: all its arguments on one line, or one per line."""
    line = f"            {word},\n"
    if len(line) <= WIDTH:
        return line
    name, _, inner = word.removesuffix(")").partition("(")
    indent = " " * 16
    if len(indent + inner) > WIDTH:
        inner = inner.replace(", ", f",\n{indent}") + ","
    return f"            {name}(\n{indent}{inner}\n            ),\n"


def call(name, words):
    line = f"{name}({', '.join(words)})\n"
    if len(line) <= WIDTH:
        return line
    return f"{name}(\n" + "".join(map(argument_line, words)) + "        )\n"


def method(command):
    kind, _, key = command.returns.partition(" ")
    result, helper = RETURNS[kind]
    words = [f'"{key}"'] * bool(key) + [f'"{command.name}"', *request_words(command)]
    returns = "" if kind == "nothing" else "return "
    return signature(command, result) + docstring(command) + call(f"        {returns}self.{helper}", words)


def commands(protocol):
    return "\n" + "\n".join(method(command) for command in protocol.commands if command.returns != "own") + "\n"


def length(one):
    return f'"{one}"' if isinstance(one, str) else str(one)


def fields(protocol):
    defaults = "".join(f'    "{field.name}": "{field.encoding}",\n' for field in protocol.byte_fields)
    shapes = "".join(
        f'    "{field.name}": ({", ".join(map(length, field.shape))}{"," * (len(field.shape) == 1)}),\n'
        for field in protocol.byte_fields
    )
    return (
        f"# The encoding of each field when `observe` does not name one.\nUSUAL_ENCODING = {{\n{defaults}}}\n"
        f"SHAPES: dict[str, tuple[int | str, ...]] = {{\n{shapes}}}\n"
    )


def files(protocol, read):
    contents = {
        FIELDS: with_region(read(FIELDS), "", "#", "fields", fields(protocol)),
        COMMANDS: with_region(read(COMMANDS), "    ", "#", "commands", commands(protocol)),
    }
    modules = {
        name: contents.get(f"{FOLDER}/{name}.py") or read(f"{FOLDER}/{name}.py") for name in python_single_file.MODULES
    }
    return contents | {SINGLE_FILE: python_single_file.joined(modules)}
