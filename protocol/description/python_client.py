"""The tables and the methods of the client in Python."""

import itertools
import textwrap

from regions import with_region

PATH = "clients/python/racebeam/wire/client.py"
WIDTH = 120
TYPES = {"int": "int", "seed": "int | str", "flag": "bool | int", "text": "str", "fields": "str", "texts": "str", "actions": "object"}
RETURNS = {"first": ("Values", "_first"), "groups": ("list[Values]", "_rest"), "nothing": ("None", "ask"),
           "list": ("list[str]", "list_of"), "ints": ("list[int]", "_ints_of")}


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
    return f"*_words({argument.name})" if argument.optional else argument.name


def request_words(command):
    """The expressions of the arguments. Neighbouring pairs go together."""
    for has_key, arguments in itertools.groupby(command.arguments, key=lambda argument: bool(argument.key)):
        if has_key:
            yield f"*_pairs({', '.join(f'{argument.key}={argument.name}' for argument in arguments)})"
        else:
            yield from map(in_request, arguments)


def signature(command, result):
    parameters = ["self", *(parameter(argument) for argument in [*command.words, *command.keys])]
    line = f"    def {command.method}({', '.join(parameters)}) -> {result}:\n"
    if len(line) <= WIDTH:
        return line
    return f"    def {command.method}(\n" + "".join(f"        {one},\n" for one in parameters) + f"    ) -> {result}:\n"


def docstring(command):
    explained = [argument for argument in command.arguments if argument.about]
    text = folded(f'"""{sentence(command.summary)}', " " * 8)
    if not explained:
        return text[:-1] + '"""\n'
    rows = "".join(folded(f"{argument.name}: {sentence(argument.about)}", " " * 12, "    ") for argument in explained)
    return f'{text}\n        Args:\n{rows}        """\n'


def call(name, words):
    line = f"{name}({', '.join(words)})\n"
    if len(line) <= WIDTH:
        return line
    return f"{name}(\n" + "".join(f"            {word},\n" for word in words) + "        )\n"


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
    usual = "".join(f'    "{field.name}": "{field.encoding}",\n' for field in protocol.byte_fields)
    shapes = "".join(f'    "{field.name}": ({", ".join(map(length, field.shape))}{"," * (len(field.shape) == 1)}),\n'
                     for field in protocol.byte_fields)
    return (f"# What bytes are written in when `observe` does not say.\nUSUAL_ENCODING = {{\n{usual}}}\n"
            f"SHAPES: dict[str, tuple[int | str, ...]] = {{\n{shapes}}}\n")


def files(protocol, read):
    text = with_region(read(PATH), "", "#", "fields", fields(protocol))
    return {PATH: with_region(text, "    ", "#", "commands", commands(protocol))}
