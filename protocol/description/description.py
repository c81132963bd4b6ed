"""The description of the protocol, protocol/protocol.toml, as objects. A mistake in it raises ValueError."""

import dataclasses
import math
import pathlib
import re

import tomllib

ROOT = pathlib.Path(__file__).resolve().parents[2]
SOURCE = ROOT / "protocol/protocol.toml"

NEEDS = ("nothing", "admission", "game", "machines")
TYPES = ("int", "seed", "real", "text", "flag", "ints", "texts", "hex", "base64", "rewards", "names")
SEVERAL = ("fields", "actions", "lists", "settings", "texts")  # types of arguments of several words
RETURNS = re.compile(r"first|groups|nothing|own|(list|ints) \w+")
EVALUATION_SETTINGS = ("frame_skip", "sticky", "action_set", "max_episode_frames", "noop_max")
NAME = re.compile(r"[a-z][a-z0-9_]*")


class Row:
    """What the rows of all tables have: `deprecated` is what to use instead."""

    deprecated: str

    @property
    def summary_text(self):
        """The summary, as `help` and the document have it."""
        text = next(getattr(self, name) for name in ("summary", "meaning", "source") if hasattr(self, name))
        return f"{text} (deprecated: use {self.deprecated})" if self.deprecated else text


@dataclasses.dataclass(frozen=True)
class Argument:
    """A word of a request, or a pair KEY=VALUE."""

    type: str
    word: str = ""
    key: str = ""
    text: str = ""
    choices: dict[str, str] = dataclasses.field(default_factory=dict)
    choices_of: str = ""
    default: str = ""
    optional: bool = False
    about: str = ""
    old: str = ""
    old_values: dict[str, str] = dataclasses.field(default_factory=dict)

    @property
    def name(self):
        return self.word or self.key

    @property
    def under_old_name(self):
        """The argument with its old key, and with the values that the old key had."""
        now = {value: old for old, value in self.old_values.items()}
        choices = {now.get(value, value): meaning for value, meaning in self.choices.items()}
        return dataclasses.replace(self, key=self.old, old="", about=f"old name of `{self.key}`", choices=choices)

    @property
    def is_repeated(self):
        return self.type in SEVERAL

    @property
    def usage(self):
        text = self.text or "|".join(self.choices)
        text = f"{self.key}={text}" if self.key else text
        return f"[{text}]" if self.optional else text


@dataclasses.dataclass(frozen=True)
class Command(Row):
    name: str
    needs: str
    summary: str
    returns: str
    since: str
    hint: str = ""
    example: str = ""
    usage: str = ""
    method: str = ""
    shows: str = ""
    echoes: str = ""
    least: int = -1
    most: int | float = -1
    arguments: tuple[Argument, ...] = ()
    reply: dict[str, str] = dataclasses.field(default_factory=dict)
    groups: dict[str, str] = dataclasses.field(default_factory=dict)
    deprecated: str = ""

    @property
    def words(self):
        return [argument for argument in self.arguments if argument.word]

    @property
    def keys(self):
        return [argument for argument in self.arguments if argument.key]

    @property
    def old_keys(self):
        """The old names of keys, as arguments, for programs that were written with them."""
        return [argument.under_old_name for argument in self.keys if argument.old]


@dataclasses.dataclass(frozen=True)
class Setting(Row):
    name: str
    type: str
    accepted: str
    default: str
    summary: str
    since: str
    choices: dict[str, str] = dataclasses.field(default_factory=dict)
    old_values: dict[str, str] = dataclasses.field(default_factory=dict)
    deprecated: str = ""

    @property
    def values(self):
        """The words that are accepted, where that is a list of them."""
        words = list(self.choices) or re.split(r", | or ", self.accepted)
        return words if len(words) > 1 and not any(" " in word for word in words) else []


def words_by_name(text):
    """The values of words KEY=VALUE, by their keys."""
    return dict(word.split("=") for word in text.split())


@dataclasses.dataclass(frozen=True)
class Preset(Row):
    name: str
    source: str
    sets: str
    since: str
    deprecated: str = ""

    @property
    def settings(self):
        return words_by_name(self.sets)


@dataclasses.dataclass(frozen=True)
class EvaluationPreset:
    name: str
    sets: str
    since: str

    @property
    def settings(self):
        return words_by_name(self.sets)


@dataclasses.dataclass(frozen=True)
class Field(Row):
    name: str
    summary: str
    since: str
    type: str = "int"
    of_request: bool = False
    shape: tuple[int | str, ...] = ()
    encoding: str = ""
    deprecated: str = ""

    @property
    def is_stack(self):
        """Whether the size is in the name."""
        return "N" in self.shape

    @property
    def fixed_size(self):
        """The bytes, where they are always the same."""
        if self.varies or not self.shape or not all(isinstance(length, int) for length in self.shape):
            return None
        return math.prod(self.shape)

    @property
    def varies(self):
        """Whether the size changes from reply to reply: a length is -1."""
        return -1 in self.shape

    @property
    def is_of_screen(self):
        """Whether the size is that of the screen."""
        return not self.varies and not self.fixed_size

    @property
    def bytes_of_pixel(self):
        """The bytes of a pixel, in a field of the size of the screen."""
        return math.prod(self.shape[2:])


@dataclasses.dataclass(frozen=True)
class Encoding(Row):
    name: str
    summary: str
    since: str
    deprecated: str = ""


@dataclasses.dataclass(frozen=True)
class Error(Row):
    code: str
    meaning: str
    since: str
    deprecated: str = ""


@dataclasses.dataclass(frozen=True)
class OldWord:
    """A word of a request that has a new name. `of` is the command, or "field".

    Attributes:
        old: A key, a pair KEY=VALUE or a field.
        is_same: Whether the server takes the one for the other.
    """

    of: str
    old: str
    now: str
    is_same: bool = True


@dataclasses.dataclass(frozen=True)
class Protocol:
    version: int
    since: str
    commands: tuple[Command, ...]
    aliases: dict[str, str]
    settings: tuple[Setting, ...]
    presets: tuple[Preset, ...]
    evaluation_presets: tuple[EvaluationPreset, ...]
    fields: tuple[Field, ...]
    old_fields: dict[str, str]
    encodings: tuple[Encoding, ...]
    joystick: tuple[str, ...]  # the names of actions
    console: dict[str, str]  # the names of those that follow them, and what they do
    errors: tuple[Error, ...]

    @property
    def old_words(self):
        """The words that have a new name, in the order of the description."""
        for command in self.commands:
            for row in self.settings if command.echoes and command.arguments else ():
                if row.deprecated:
                    yield OldWord(command.name, row.name, row.deprecated, is_same=False)
                yield from old_values(command.name, row.name, row.name, row.old_values)
            for argument in command.keys:
                if argument.old:
                    yield from old_values(command.name, argument.old, argument.key, argument.old_values)
                    yield OldWord(command.name, argument.old, argument.key)
                yield from old_values(command.name, argument.key, argument.key, argument.old_values)
        for old, now in self.old_fields.items():
            yield OldWord("field", old, now)

    @property
    def byte_fields(self):
        """The fields of bytes whose names are fixed."""
        return [field for field in self.fields if field.shape and not field.is_stack]


def old_values(command, old_key, key, values):
    return [OldWord(command, f"{old_key}={old}", f"{key}={now}") for old, now in values.items()]


def expect(condition, sentence):
    if not condition:
        raise ValueError(f"{SOURCE}: {sentence}")


def rows(table, kind, document):
    """The rows of a table of the document, as objects."""
    names = {field.name for field in dataclasses.fields(kind)}
    for row in document.get(table, []):
        unknown = set(row) - names
        expect(
            not unknown, f"rows of {table} have no {', '.join(sorted(unknown))}; they have {', '.join(sorted(names))}"
        )
        try:
            yield kind(
                **{
                    "since": document["since"],
                    **{key: tuple(value) if isinstance(value, list) else value for key, value in row.items()},
                }
            )
        except TypeError as error:
            raise ValueError(f"{SOURCE}: {table} {row.get('name', row.get('code', ''))}: {error}") from None


def with_choices(argument, settings):
    """An argument with the choices of the setting that it names, its default first."""
    if not argument.choices_of:
        return argument
    expect(argument.choices_of in settings, f"{argument.name}: unknown setting {argument.choices_of!r}")
    choices = settings[argument.choices_of].choices
    first = {argument.default: choices[argument.default]} if argument.default else {}
    return dataclasses.replace(argument, choices=first | choices)


def completed(command, settings):
    """A command with its arguments as objects, and with what follows from them."""
    arguments = tuple(with_choices(Argument(**argument), settings) for argument in command.arguments)
    required = sum(1 for argument in arguments if not argument.optional)
    limit = math.inf if any(argument.is_repeated for argument in arguments) else len(arguments)
    return dataclasses.replace(
        command,
        arguments=arguments,
        method=command.method or command.name,
        usage=command.usage or " ".join(argument.usage for argument in arguments),
        least=required if command.least < 0 else command.least,
        most=limit if command.most < 0 else command.most,
    )


def check(protocol):
    for command in protocol.commands:
        where = f"command {command.name}: "
        expect(NAME.fullmatch(command.name), f"{where}the name has other signs than a to z, 0 to 9 and _")
        expect(command.needs in NEEDS, f"{where}needs is {command.needs!r}; it is one of {', '.join(NEEDS)}")
        expect(RETURNS.fullmatch(command.returns), f"{where}returns is {command.returns!r}")
        expect(command.shows in ("", "first", "groups", "asked"), f"{where}shows is {command.shows!r}")
        for argument in command.arguments:
            expect(bool(argument.word) != bool(argument.key), f"{where}an argument has either a word or a key")
            expect(argument.type in TYPES + SEVERAL, f"{where}the type of {argument.name} is {argument.type!r}")
        for key, kind in (command.reply | command.groups).items():
            expect(kind in TYPES, f"{where}the type of the key {key} is {kind!r}; it is one of {', '.join(TYPES)}")
    encodings = [encoding.name for encoding in protocol.encodings]
    for field in protocol.fields:
        expect(
            bool(field.shape) == bool(field.encoding),
            f"field {field.name}: a field of bytes has a shape and an encoding",
        )
        expect(
            not field.encoding or field.encoding in encodings,
            f"field {field.name}: unknown encoding {field.encoding!r}",
        )
    for preset in protocol.evaluation_presets:
        expect(
            tuple(preset.settings) == EVALUATION_SETTINGS,
            f"evaluation_preset {preset.name}: sets {preset.sets!r}; it sets {', '.join(EVALUATION_SETTINGS)}",
        )
    for table in (protocol.commands, protocol.settings, protocol.presets, protocol.fields, protocol.encodings):
        names = [row.name for row in table]
        expect(
            len(set(names)) == len(names),
            f"a name is there twice: {sorted(name for name in names if names.count(name) > 1)}",
        )


def read(path=SOURCE):
    document = tomllib.loads(path.read_text())
    settings = {setting.name: setting for setting in rows("setting", Setting, document)}
    protocol = Protocol(
        version=document["protocol"],
        since=document["since"],
        commands=tuple(completed(command, settings) for command in rows("command", Command, document)),
        aliases=document["aliases"],
        settings=tuple(settings.values()),
        presets=tuple(rows("preset", Preset, document)),
        evaluation_presets=tuple(rows("evaluation_preset", EvaluationPreset, document)),
        fields=tuple(rows("field", Field, document)),
        old_fields=document["old_fields"],
        encodings=tuple(rows("encoding", Encoding, document)),
        joystick=tuple(document["actions"]["joystick"]),
        console=document["actions"]["console"],
        errors=tuple(rows("error", Error, document)),
    )
    check(protocol)
    return protocol
