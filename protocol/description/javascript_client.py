"""The tables and the methods of the client in JavaScript, and their types for TypeScript."""

from comments import COLUMNS, comment_lines
from regions import with_region

HEAD = "// Made from protocol/protocol.toml by protocol/description/generate. Do not change it by hand.\n\n"
FOLDER = "clients/js/src"
TYPES = {
    "int": "number",
    "seed": 'number | "random"',
    "flag": "0 | 1 | boolean",
    "text": "string",
    "fields": "string",
    "texts": "string",
    "actions": "Action",
}
RESULTS = {"first": "Group", "groups": "Group[]", "nothing": "void", "list": "string[]", "ints": "number[]"}


def camel(name):
    first, *rest = name.split("_")
    return first + "".join(part.capitalize() for part in rest)


def sentence(text):
    return text[0].upper() + text[1:] + "."


class Signature:
    """The parameters of a command's method: words, then the settings or the one setting, then what is repeated."""

    def __init__(self, command):
        self.command = command
        self.words = [argument for argument in command.words if not argument.is_repeated]
        self.repeated = next((argument for argument in command.words if argument.is_repeated), None)
        self.setting = command.keys[0] if len(command.keys) == 1 and not self.repeated else None
        self.settings = [] if self.setting else command.keys

    def parameters(self):
        yield from (argument.name for argument in self.words)
        if self.setting:
            yield self.setting.name
        if self.settings:
            yield "settings = {}"
        if self.repeated:
            yield f"...{self.repeated.name}"

    def request(self):
        """The parts of the request, in its order."""
        yield f'"{self.command.name}"'
        has_settings = False
        for argument in self.command.arguments:
            if argument.key and self.setting:
                yield f'keyed("{argument.key}", {argument.name})'
            elif argument.key and not has_settings:
                has_settings = True
                yield "settings"
            elif argument.is_repeated:
                yield f"...{argument.name}"
            elif not argument.key:
                yield f"{argument.name} ?? []" if argument.optional else argument.name

    def types(self):
        for argument in self.words:
            or_settings = " | Settings" * (argument.optional and bool(self.command.keys))
            yield f"{argument.name}{'?' * argument.optional}: {TYPES[argument.type]}{or_settings}"
        if self.setting:
            name, kind = self.setting.name, TYPES[self.setting.type]
            yield f"{name}?: {kind} | {{ {name}?: {kind} }}"
        if self.settings:
            yield f"settings?: {settings_type(self.settings + self.command.old_keys)}"
        if self.repeated:
            yield f"...{self.repeated.name}: {TYPES[self.repeated.type]}[]"


def settings_type(arguments):
    keys = [f"{argument.key}?: {typescript(argument)};" for argument in arguments]
    line = "{ " + " ".join(keys) + " }"
    return line if len(line) < 80 else "{\n" + "".join(f"    {key}\n" for key in keys) + "  }"


def typescript(argument):
    if argument.choices and argument.type == "text":
        return " | ".join(f'"{value}"' for value in argument.choices)
    return TYPES[argument.type]


def method(command):
    kind, _, key = command.returns.partition(" ")
    signature = Signature(command)
    request = f"await this.request({', '.join(signature.request())})"
    body = {
        "first": f"return ({request})[0];",
        "groups": f"return ({request}).slice(1);",
        "nothing": f"{request};",
        "list": f"return list(({request})[0].{key});",
        "ints": f"return list(({request})[0].{key}).map(Number);",
    }[kind]
    return f"  async {camel(command.method)}({', '.join(signature.parameters())}) {{\n    {body}\n  }}\n"


def generated(protocol):
    return [command for command in protocol.commands if command.returns != "own"]


def commands(protocol):
    methods = "\n".join(method(command) for command in generated(protocol))
    return (
        f'{HEAD}import {{ keyed, list }} from "./words.js";\n\n'
        "/** The commands whose methods only send their words. `request` is a session's. */\n"
        f"export class Commands {{\n{methods}}}\n"
    )


def declaration(command):
    """The type of a method, and its comment, a line for each parameter that is explained."""
    kind, _, _ = command.returns.partition(" ")
    signature = Signature(command)
    about = [
        f"@param {'settings.' * (argument in signature.settings)}{argument.name} {argument.about}"
        for argument in command.arguments
        if argument.about
    ]
    summary = sentence(command.summary)
    lines = ["  /**", *comment_lines("   * ", summary, *about), "   */"] if about else [f"  /** {summary} */"]
    lines.append(f"  {camel(command.method)}({', '.join(signature.types())}): Promise<{RESULTS[kind]}>;")
    return "".join(f"{line}\n" for line in lines)


def setting_type(setting, presets):
    """The type of a setting of load, with what stands before it."""
    words = ["none", *(preset.name for preset in presets)] if setting.name == "preset" else setting.values
    if words and setting.type == "text":
        line = " | ".join(f'"{word}"' for word in words)
        return f" {line}" if len(line) < 80 else "".join(f'\n    | "{word}"' for word in words)
    if setting.type == "text":
        return " string" if setting.name == "scheme" else " number | string"
    return " " + TYPES["seed" if setting.default == "random" else {"real": "int"}.get(setting.type, setting.type)]


def load_settings(protocol):
    """A member for each setting of load, with its comment."""
    for setting in protocol.settings:
        if not setting.deprecated:
            kind = setting_type(setting, protocol.presets)
            accepted = "" if '"' in kind and kind.strip() != TYPES["seed"] else f" Accepted: {setting.accepted}."
            text = f"{sentence(setting.summary)}{accepted} Default: {setting.default}."
            short = f"  /** {text} */"
            lines = [short] if len(short) <= COLUMNS else ["  /**", *comment_lines("   * ", text), "   */"]
            lines.append(f"  {setting.name}?:{kind};")
            yield "".join(f"{line}\n" for line in lines)


def entries_of(protocol):
    """The facts of fields of bytes whose names are fixed: usual encodings, sizes, and the bytes of a pixel."""
    return (
        [(field.name, f'"{field.encoding}"') for field in protocol.byte_fields],
        [(field.name, field.fixed_size) for field in protocol.byte_fields if field.fixed_size],
        [(field.name, field.bytes_of_pixel) for field in protocol.byte_fields if field.is_of_screen],
    )


def object_of(pairs):
    return "{\n" + "".join(f"  {key}: {value},\n" for key, value in pairs) + "}"


def fields(protocol):
    usual, sizes, pixels = map(object_of, entries_of(protocol))
    return (
        f"{HEAD}/** The encodings of fields of bytes where a request does not name one. */\n"
        f"export const USUAL = {usual};\n"
        f"/** The sizes in bytes of fields whose size never changes. */\nexport const SIZES = {sizes};\n"
        f"/** Bytes per pixel of fields with the size of the screen. */\nexport const PIXELS = {pixels};\n"
    )


def files(protocol, read):
    types = f"{FOLDER}/index.d.ts"
    methods = "".join(map(declaration, generated(protocol)))
    declared = with_region(read(types), "  ", "//", "settings", "".join(load_settings(protocol)))
    return {
        f"{FOLDER}/commands.js": commands(protocol),
        f"{FOLDER}/field_table.js": fields(protocol),
        types: with_region(declared, "  ", "//", "commands", methods),
    }
