"""Compares replies with the keys and types that protocol/protocol.toml describes."""

import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[3] / "protocol/description"))
import description  # noqa: E402

PROTOCOL = description.read()
COMMANDS = {command.name: command for command in PROTOCOL.commands}
CODES = {error.code for error in PROTOCOL.errors}
SETTINGS = {setting.name: setting.type for setting in PROTOCOL.settings}
FIELDS = {field.name: field for field in PROTOCOL.fields}
STACK = re.compile(r"grey84(x\d+)?|(grey|rgb)(\d+x\d+x\d+)")

INT, LIST = r"-?\d+", r"[^,\s]*(,[^,\s]+)*"
FORMS = {
    "int": INT,
    "real": r"-?\d+(\.\d+)?(e-?\d+)?",
    "text": r"\S*",
    "flag": "[01]",
    "ints": rf"({INT}(,{INT})*)?",
    "texts": LIST,
    "hex": "([0-9A-F]{2})*",
    "base64": r"[A-Za-z0-9+/]*={0,2}",
    "rewards": rf"{INT}(\*\d+)?(,{INT}(\*\d+)?)*",
    "names": r"(\d+:\w+(,\d+:\w+)*)?",
}


class Undescribed(AssertionError):
    """A reply that has another form than the description says."""


def expect(condition, request, what):
    if not condition:
        raise Undescribed(f"the reply to {request!r} {what}")


def form_of_field(key):
    """The form of a field's value, or None."""
    name = key.removeprefix("final_")
    if STACK.fullmatch(name):
        return r"\S*"
    field = FIELDS.get(name)
    return field and (r"\S*" if field.shape else FORMS[field.type])


def check_group(request, types, others, words):
    pairs = [word.partition("=") for word in words]
    expect(all(equals for _, equals, _ in pairs), request, f"has a word without '=': {words}")
    keys = [key for key, _, _ in pairs]
    expect(len(set(keys)) == len(keys), request, f"has a key twice: {keys}")
    missing = [key for key in types if not key.endswith("?") and key not in keys]
    expect(not missing, request, f"lacks {missing}")
    plain = {key.removesuffix("?"): kind for key, kind in types.items()}
    for key, _, value in pairs:
        form = FORMS[plain[key]] if key in plain else others(key)
        expect(form, request, f"has the key {key}, which is not described")
        expect(
            re.fullmatch(form, value), request, f"has {key}={value[:60]}, which is not {plain.get(key, 'as described')}"
        )


def check(request, reply):
    """Raises Undescribed if the reply's line is not as described. Both are texts."""
    status, _, rest = reply.rstrip("\n").partition(" ")
    if status == "error":
        expect(rest.split(" ")[0] in CODES and " " in rest, request, f"has no code or no sentence: {reply[:100]!r}")
        return
    expect(status == "ok", request, f"begins with neither ok nor error: {reply[:100]!r}")
    name = request.split()[0]
    command = COMMANDS[PROTOCOL.aliases.get(name, name)]
    if command.name == "help":
        return
    for place, group in enumerate(f" {rest}".split(" |")):
        shows = command.shows == "groups" if place else command.shows in ("first", "asked")
        types = command.groups if place else command.reply

        def others(key, shows=shows):
            if key == "raw":
                return INT
            setting = SETTINGS.get(key) if command.echoes else None
            return FORMS[setting] if setting else form_of_field(key) if shows else None

        check_group(request, types, others, group.split())
