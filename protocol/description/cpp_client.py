"""The tables and the methods of the client in C++."""

from comments import about_number, comment_lines
from javascript_client import generated, sentence

from server import HEAD, quoted

FOLDER = "clients/cpp/racebeam/client"
TYPES = {"int": "std::int64_t", "seed": "std::int64_t", "flag": "bool", "text": "std::string_view"}
RESULTS = {
    "first": ("first", "Group"),
    "groups": ("rest", "the Group of each"),
    "nothing": ("first", ""),
    "list": ('list("{key}")', "a list"),
    "ints": ('numbers("{key}")', "a list of numbers"),
}


class Shape:
    """The parameters of a command's method: those that are required, and a pack of all others."""

    def __init__(self, command):
        self.required = [argument for argument in command.words if not argument.optional and not argument.is_repeated]
        self.others = [argument for argument in command.arguments if argument not in self.required]
        # A command that takes one key, and nothing else, has a method with its value instead.
        self.only_key = self.others[0] if len(self.others) == 1 and self.others[0].key and not self.required else None
        self.pack = next(
            (argument.name for argument in self.others if argument.is_repeated), "settings" if command.keys else "words"
        )


def explained(argument):
    value = f'`Setting("{argument.key}", {argument.text or "VALUE"})`: ' if argument.key else ""
    return f"{value}{argument.about}"


def comment(command, shape, result):
    lines = [sentence(command.summary) + (f" Returns {result}." if result else "")]
    lines += [f"@param {argument.name} {argument.about or argument.usage}" for argument in shape.required]
    if shape.others and not shape.only_key:
        about = [explained(argument) for argument in shape.others if argument.about]
        lines.append(
            f"@param {shape.pack} "
            f"{'; '.join(about) or '`' + ' '.join(argument.usage for argument in shape.others) + '`'}"
        )
    return "".join(f"{line}\n" for line in comment_lines("  /// ", *lines))


def method(command):
    kind, _, key = command.returns.partition(" ")
    read, result = RESULTS[kind]
    shape = Shape(command)
    head = comment(command, shape, result)
    called = [read.replace("{key}", key), quoted(command.name), *(argument.name for argument in shape.required)]
    parameters = [f"{TYPES[argument.type]} {argument.name}" for argument in shape.required]
    if not shape.others:
        return f"{head}  auto {command.method}({', '.join(parameters)}) {{ return ask({', '.join(called)}); }}\n"
    if shape.only_key:
        argument = shape.only_key
        return (
            f"{head}  auto {command.method}() {{ return ask({', '.join(called)}); }}\n"
            f"  /// The same with {argument.key}: {about_number(argument)}.\n"
            f"  auto {command.method}({TYPES[argument.type]} {argument.key}) {{\n"
            f"    return ask({', '.join([*called, f'Setting({quoted(argument.key)}, {argument.key})'])});\n  }}\n"
        )
    return (
        f"{head}  template <class... Words>\n"
        f"  auto {command.method}({', '.join([*parameters, f'const Words&... {shape.pack}'])}) {{\n"
        f"    return ask({', '.join([*called, f'{shape.pack}...'])});\n  }}\n"
    )


BEGIN = """#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "racebeam/client/config.hpp"
#include "racebeam/client/reply.hpp"
#include "racebeam/client/words.hpp"

namespace RACEBEAM_CLIENT_NAMESPACE {

/// The commands whose methods only send their words. `Derived` sends them.
template <class Derived>
class CommandMethods {
 public:
"""

END = """
 protected:
  CommandMethods() = default;

  template <class Read, class... Words>
  auto ask(Read read, std::string_view command, const Words&... words) {
    return static_cast<Derived&>(*this).ask_for(detail::request_line(command, words...), std::move(read));
  }

  static Group first(const Reply& reply) { return reply.first(); }
  static std::vector<Group> rest(const Reply& reply) { return reply.rest(); }
  static auto list(const char* key) {
    return [key](const Reply& reply) { return reply.first().list(key); };
  }
  static auto numbers(const char* key) {
    return [key](const Reply& reply) {
      std::vector<int> found;
      for (const std::string& number : reply.first().list(key)) found.push_back(detail::to_number<int>(number));
      return found;
    };
  }
};

}  // namespace RACEBEAM_CLIENT_NAMESPACE
"""


def commands(protocol):
    return HEAD + BEGIN + "\n".join(method(command) for command in generated(protocol)) + END


def table(kind, name, pairs):
    rows = list(pairs)
    values = "".join(f"    {{{quoted(key)}, {value}}},\n" for key, value in rows)
    return f"inline constexpr std::array<std::pair<std::string_view, {kind}>, {len(rows)}> {name}{{{{\n{values}}}}};\n"


def enumerator(encoding):
    return f"Encoding::k{encoding.capitalize()}"


def fields(protocol):
    fields = protocol.byte_fields
    return (
        f"{HEAD}#pragma once\n\n#include <array>\n#include <cstddef>\n#include <string_view>\n#include <utility>\n\n"
        '#include "racebeam/client/config.hpp"\n#include "racebeam/client/encoding.hpp"\n\n'
        "namespace RACEBEAM_CLIENT_NAMESPACE::detail {\n\n"
        "/// The encodings of fields of bytes where a request does not name one.\n"
        + table("Encoding", "kUsual", ((field.name, enumerator(field.encoding)) for field in fields))
        + "/// The sizes in bytes of fields whose size never changes.\n"
        + table("std::size_t", "kSizes", ((field.name, field.fixed_size) for field in fields if field.fixed_size))
        + "/// Bytes per pixel of fields with the size of the screen.\n"
        + table(
            "std::size_t", "kPixels", ((field.name, field.bytes_of_pixel) for field in fields if field.is_of_screen)
        )
        + "\n}  // namespace RACEBEAM_CLIENT_NAMESPACE::detail\n"
    )


def files(protocol, read):
    return {f"{FOLDER}/command_methods.hpp": commands(protocol), f"{FOLDER}/field_table.hpp": fields(protocol)}
