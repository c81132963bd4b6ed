"""The tables and the methods of the client in C++."""

from javascript_client import generated
from server import HEAD, quoted

FOLDER = "clients/cpp/racebeam/client"
TYPES = {"int": "std::int64_t", "flag": "bool", "text": "std::string_view"}
RESULTS = {"first": ("first", "Group"), "groups": ("rest", "the Group of each"), "nothing": ("first", ""),
           "list": ('list("{key}")', "a list"), "ints": ('numbers("{key}")', "a list of numbers")}


def one_key(command):
    """The key of a command that takes nothing else."""
    return command.keys[0] if len(command.arguments) == 1 and command.keys else None


def comment(command, told):
    lines = [command.summary + (f": {told}" if told else "") + "."]
    lines += [f"@param {argument.name} {argument.about}" for argument in command.arguments if argument.about and not argument.key]
    lines += [f'@param words with `Setting("{argument.key}", ...)`: {argument.about}' for argument in command.keys if not one_key(command)]
    return "".join(f"  /// {line}\n" for line in lines)


def method(command):
    kind, _, key = command.returns.partition(" ")
    read, told = RESULTS[kind]
    read = read.replace("{key}", key)
    required = [argument for argument in command.words if not argument.optional and not argument.is_repeated]
    parameters = [f"{TYPES[argument.type]} {argument.name}" for argument in required]
    names = [argument.name for argument in required]
    head = comment(command, told)
    if not command.arguments or len(required) == len(command.arguments):
        return f"{head}  auto {command.method}({', '.join(parameters)}) {{ return ask({', '.join([read, quoted(command.name), *names])}); }}\n"
    if argument := one_key(command):
        return (f"{head}  auto {command.method}() {{ return ask({read}, {quoted(command.name)}); }}\n"
                f"  /// The same. {argument.key}: {argument.about}.\n"
                f"  auto {command.method}({TYPES[argument.type]} {argument.key}) {{\n"
                f"    return ask({read}, {quoted(command.name)}, Setting({quoted(argument.key)}, {argument.key}));\n  }}\n")
    return (f"{head}  template <class... Words>\n"
            f"  auto {command.method}({', '.join([*parameters, 'const Words&... words'])}) {{\n"
            f"    return ask({', '.join([read, quoted(command.name), *names, 'words...'])});\n  }}\n")


def commands(protocol):
    return "\n".join(method(command) for command in generated(protocol))


def table(kind, name, pairs):
    rows = list(pairs)
    values = ", ".join(f"{{{quoted(key)}, {value}}}" for key, value in rows)
    return f"inline constexpr std::array<std::pair<std::string_view, {kind}>, {len(rows)}> {name}{{{{{values}}}}};\n"


def enumerator(encoding):
    return f"Encoding::k{encoding.capitalize()}"


def fields(protocol):
    named = protocol.byte_fields
    return (f"{HEAD}#pragma once\n\n#include <array>\n#include <cstddef>\n#include <string_view>\n#include <utility>\n\n"
            '#include "racebeam/client/encoding.hpp"\n\nnamespace racebeam::client::detail {\n\n'
            "/// What bytes are written in where the client does not say.\n"
            + table("Encoding", "kUsual", ((field.name, enumerator(field.encoding)) for field in named))
            + "/// Bytes of fields that always have the same number.\n"
            + table("std::size_t", "kSizes", ((field.name, field.fixed_size) for field in named if field.fixed_size))
            + "/// Bytes of a pixel of fields that have the size of the screen.\n"
            + table("std::size_t", "kPixels", ((field.name, field.bytes_of_pixel) for field in named if not field.fixed_size))
            + "\n}  // namespace racebeam::client::detail\n")


def files(protocol, read):
    return {f"{FOLDER}/command_methods.inc": f"{HEAD}\n{commands(protocol)}", f"{FOLDER}/field_table.hpp": fields(protocol)}
