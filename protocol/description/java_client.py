"""The tables and the methods of the client in Java."""

from comments import about_number, comment_lines
from javascript_client import camel, generated, sentence

FOLDER = "clients/java/src/main/java/racebeam"
HEAD = (
    "// Made from protocol/protocol.toml by protocol/description/generate. Do not change it by hand.\n"
    "package racebeam;\n\n"
)
TYPES = {"int": "long", "seed": "long", "flag": "boolean", "text": "String"}
# Type, what is returned, and how the Javadoc calls it.
RESULTS = {
    "first": ("Group", "return request(line{}).first();", "the first group of the reply"),
    "groups": ("List<Group>", "return request(line{}).rest();", "the groups after the first"),
    "nothing": ("void", "request(line{});", ""),
    "list": ("List<String>", 'return request(line{}).first().list("{key}");', "the list {key} of the reply"),
    "ints": ("List<Integer>", 'return integers(request(line{}).first().list("{key}"));', "the list {key} of the reply"),
}


def overloads(command):
    """The parameters of each method of a command: with and without what may be left out. A command with one key takes
    its value, and one with several takes a map."""
    required = [argument for argument in command.words if not argument.optional and not argument.is_repeated]
    optional = [argument for argument in command.words if argument.optional and not argument.is_repeated]
    repeated = [argument for argument in command.words if argument.is_repeated]
    settings = [command.keys[0] if len(command.keys) == 1 else None] if command.keys else []
    for words in ([], optional) if optional else ([],):
        for keys in ([], settings) if settings else ([],):
            yield [*required, *words, *keys, *repeated]


def parameter(argument):
    if argument is None:
        return "Map<String, ?> settings"
    return f"String... {argument.name}" if argument.is_repeated else f"{TYPES[argument.type]} {argument.name}"


def name_of(argument):
    return "settings" if argument is None else argument.name


def expression(argument):
    """What puts an argument into the line."""
    if argument is None:
        return "Racebeam.pairs(settings)"
    value = f"({argument.name} ? 1 : 0)" if argument.type == "flag" else argument.name
    if argument.key:
        return f'" {argument.key}=" + {value}'
    return f"words({argument.name})" if argument.is_repeated else f'" " + {argument.name}'


def explained(command, argument):
    if argument is None:
        keys = [f"{one.key}: {one.about}" for one in command.keys]
        return "; ".join(keys)
    return about_number(argument) or argument.usage.strip("[]").replace("@", "&#64;")


def javadoc(command, parameters, result):
    rows = [f"@param {name_of(argument)} {explained(command, argument)}" for argument in parameters]
    rows += [f"@return {result}"] if result else []
    rows.append("@throws IOException if the session has ended")
    summary = comment_lines("   * ", sentence(command.summary))
    lines = ["  /**", *summary, "   *", *comment_lines("   * ", *rows), "   */"]
    return "".join(f"{line}\n" for line in lines)


def method(command, parameters):
    kind, _, key = command.returns.partition(" ")
    result, body, summary = (text.replace("{key}", key) for text in RESULTS[kind])
    line = " + ".join([f'"{command.name}"', *map(expression, parameters)]).replace('" + "', "")  # one literal
    return (
        javadoc(command, parameters, summary)
        + f"  public {result} {camel(command.method)}({', '.join(map(parameter, parameters))}) throws IOException {{\n"
        + f"    {body.replace('line{}', line)}\n  }}\n"
    )


BASE = """/** The commands whose methods only send their words. */
public abstract sealed class Commands permits Session {
  Commands() { }

  /**
   * Sends a request, and returns its reply. Replies of requests that were sent ahead stay to be received.
   *
   * @param line such as {@code act FIRE}
   * @return its reply
   * @throws IOException if the session has ended
   */
  public abstract Reply request(String line) throws IOException;

  static String words(String... words) {
    return words.length == 0 ? "" : " " + String.join(" ", words);
  }

  private static List<Integer> integers(List<String> texts) {
    return texts.stream().map(Integer::valueOf).toList();
  }

"""


def commands(protocol):
    methods = "\n".join(
        method(command, parameters) for command in generated(protocol) for parameters in overloads(command)
    )
    return f"{HEAD}import java.io.IOException;\nimport java.util.List;\nimport java.util.Map;\n\n{BASE}{methods}}}\n"


def map_of(pairs):
    return "Map.of(\n" + ",\n".join(f'      "{key}", {value}' for key, value in pairs) + ")"


def fields(protocol):
    fields = protocol.byte_fields
    defaults = map_of((field.name, f"Encoding.{field.encoding.upper()}") for field in fields)
    sizes = map_of((field.name, field.fixed_size) for field in fields if field.fixed_size)
    pixels = map_of((field.name, field.bytes_of_pixel) for field in fields if field.is_of_screen)
    return (
        f"{HEAD}import java.util.Map;\n\n/** The fields of bytes. */\nfinal class FieldTable {{\n"
        f"  /** The encodings of fields of bytes where a request does not name one. */\n"
        f"  static final Map<String, Encoding> USUAL = {defaults};\n"
        f"  /** The sizes in bytes of fields whose size never changes. */\n  static final Map<String, Integer> SIZES = "
        f"{sizes};\n"
        f"  /** Bytes per pixel of fields with the size of the screen. */\n"
        f"  static final Map<String, Integer> PIXELS = {pixels};\n\n  private FieldTable() {{ }}\n}}\n"
    )


def files(protocol, read):
    return {f"{FOLDER}/Commands.java": commands(protocol), f"{FOLDER}/FieldTable.java": fields(protocol)}
