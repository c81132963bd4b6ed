"""The tables of the program, in C++."""

import math

HEAD = """// Made from protocol/protocol.toml by protocol/description/generate. Do not change it by hand.
// clang-format off
"""


def quoted(text):
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    return f'"{escaped}"'


def enumerator(name):
    return "k" + "".join(part.capitalize() for part in name.split("-"))


def boolean(value):
    return "true" if value else "false"


def braced(*values):
    return "    {" + ", ".join(values) + "},\n"


def array(kind, name, rows):
    rows = list(rows)
    return f"inline constexpr std::array<{kind}, {len(rows)}> {name} = {{{{\n" + "".join(rows) + "}};\n"


def error_codes(protocol):
    codes = "".join(f"  {enumerator(error.code)},\n" for error in protocol.errors)
    return (
        f"{HEAD}#pragma once\n\nnamespace racebeam {{\n\nenum class ErrorCode {{\n{codes}}};\n\n}}  // "
        f"namespace racebeam\n"
    )


END = "}  // namespace racebeam::description\n"

STRUCTS = """#pragma once

#include <array>
#include <string_view>

namespace racebeam::description {

struct Field {
  std::string_view name, summary;
  bool of_request;
  std::string_view encoding;  // of bytes; empty: a number
};

struct Choice {  // a value that a key of a command, or a setting, may have
  std::string_view key, value, meaning;
};

// A word of a request that has a new name: a key, a pair KEY=VALUE or a field.
struct OldWord {
  std::string_view of;  // the command, or "field"
  std::string_view old, now;
  bool is_same;  // the server takes the one for the other
};

struct Encoding {
  std::string_view name, summary;
};

struct Error {
  std::string_view name, meaning;
};

"""

SETTING_STRUCTS = """#pragma once

#include <array>
#include <string_view>

namespace racebeam::description {

struct Setting {
  std::string_view name, accepted, summary;
  bool is_deprecated;
};

struct Preset {
  std::string_view name, words, source;
};

struct EvaluationPreset {
  std::string_view name, words;
};
"""


def reply_keys(protocol):
    """The keys of replies that handlers write."""
    replies = [reply for command in protocol.commands for reply in (command.reply, command.groups)]
    return sorted({key.removesuffix("?") for reply in replies for key in reply})


def all_choices(protocol):
    """The choices of settings and of keys of commands."""
    yield from ((setting.name, setting.choices) for setting in protocol.settings)
    for command in protocol.commands:
        yield from ((one.key, one.choices) for one in command.arguments if not one.choices_of)


def setting_tables(protocol):
    """The tables of which environment/settings makes its own."""
    return "\n".join(
        (
            HEAD + SETTING_STRUCTS,
            array(
                "Setting",
                "kSettings",
                (
                    braced(quoted(row.name), quoted(row.accepted), quoted(row.summary_text), boolean(row.deprecated))
                    for row in protocol.settings
                ),
            ),
            array(
                "Preset",
                "kPresets",
                (braced(quoted(row.name), quoted(row.sets), quoted(row.summary_text)) for row in protocol.presets),
            ),
            array(
                "EvaluationPreset",
                "kEvaluationPresets",
                (braced(quoted(row.name), quoted(row.sets)) for row in protocol.evaluation_presets),
            ),
            END,
        )
    )


def tables(protocol):
    return "\n".join(
        (
            HEAD + STRUCTS.rstrip("\n") + "\n",
            array(
                "Field",
                "kFields",
                (
                    braced(quoted(row.name), quoted(row.summary_text), boolean(row.of_request), quoted(row.encoding))
                    for row in protocol.fields
                ),
            ),
            array(
                "Choice",
                "kChoices",
                (
                    braced(quoted(key), quoted(value), quoted(meaning))
                    for key, choices in all_choices(protocol)
                    for value, meaning in choices.items()
                ),
            ),
            array(
                "OldWord",
                "kOldWords",
                (
                    braced(quoted(word.of), quoted(word.old), quoted(word.now), boolean(word.is_same))
                    for word in protocol.old_words
                ),
            ),
            array(
                "Encoding",
                "kEncodings",
                (braced(quoted(row.name), quoted(row.summary_text)) for row in protocol.encodings),
            ),
            array(
                "std::string_view",
                "kActions",
                (f"    {quoted(name)},\n" for name in (*protocol.joystick, *protocol.console)),
            ),
            array("std::string_view", "kReplyKeys", (f"    {quoted(key)},\n" for key in reply_keys(protocol))),
            array("Error", "kErrors", (braced(quoted(row.code), quoted(row.summary_text)) for row in protocol.errors)),
            END,
        )
    )


def keys(types):
    return quoted(" ".join(f"{key}:{kind}" for key, kind in types.items()))


def takes_fields(command):
    return any(argument.type == "fields" for argument in command.arguments)


def command_rows(protocol):
    """The declarations of the handlers, and the rows of command_table.cpp that bind them."""
    handlers = "".join(f"void run_{command.name}(Context&, Words, Reply&);\n" for command in protocol.commands)
    old = {word.of for word in protocol.old_words}
    rows = "".join(
        braced(
            quoted(command.name),
            quoted(command.usage),
            quoted(command.summary_text),
            quoted(command.hint),
            quoted(command.example),
            str(command.least),
            "kAnyNumber" if command.most == math.inf else str(command.most),
            f"Needs::{enumerator(command.needs)}",
            boolean(takes_fields(command)),
            boolean(takes_fields(command) or command.name in old),
            f"run_{command.name}",
            keys(command.reply),
            keys(command.groups),
            quoted(command.shows),
            quoted(command.echoes),
        )
        for command in protocol.commands
    )
    aliases = "".join(braced(quoted(name), quoted(command)) for name, command in protocol.aliases.items())
    return (
        f"{HEAD}\n{handlers}\n"
        f"constexpr std::array<Command, {len(protocol.commands)}> kCommands = {{{{\n{rows}}}}};\n\n"
        f"constexpr std::array<Alias, {len(protocol.aliases)}> kAliases = {{{{\n{aliases}}}}};\n"
    )


def files(protocol):
    return {
        "environment/settings/setting_tables.hpp": setting_tables(protocol),
        "protocol/description/error_code.hpp": error_codes(protocol),
        "protocol/description/tables.hpp": tables(protocol),
        "protocol/description/command_rows.inc": command_rows(protocol),
    }
