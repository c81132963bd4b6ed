"""What of the protocol a conversation uses, compared with what the server's help lists."""

import itertools
import pathlib
import re
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "protocol/description"))
import description  # noqa: E402

STEPS_WITH_REQUEST = (">", "send")


def help_text(racebeam, subject):
    """The sentence of `help SUBJECT`."""
    done = subprocess.run(
        [racebeam, "serve", "--stdio"], input=f"help {subject}\n", capture_output=True, text=True, check=True
    )
    return done.stdout.removeprefix("ok ").strip()


def names(text):
    """The names in a list such as `codes of errors: bad-line: the line is empty; limit: more than allowed`."""
    listed = text.partition(": ")[2]
    return [found[1] for item in listed.split("; ") if (found := re.match(r"([a-z][\w-]*)(?: \([^)]*\))?: ", item))]


def expected(racebeam):
    """Everything that the protocol has, by kind."""
    commands = help_text(racebeam, "").removeprefix("commands: ").split(";")[0].split()
    presets = re.findall(r"(\S+) \([^)]*\) sets", help_text(racebeam, "presets"))
    choices = re.findall(r"\[(\w+)=([^\]]*)\]", help_text(racebeam, "open"))
    fields = names(help_text(racebeam, "fields"))
    return {
        "command": commands,
        "setting": names(help_text(racebeam, "settings")),
        "preset": presets,
        "choice of open": [f"{key}={value}" for key, values in choices for value in values.split("|")],
        "field": fields,
        "encoding": names(help_text(racebeam, "encodings")),
        "error code": names(help_text(racebeam, "errors")),
    }


def kind_of_size(field):
    """The name that help gives to fields such as grey40x30x2."""
    return re.sub(r"^(grey|rgb)\d+x\d+x\d+$", r"\1WxHxN", field)


def usage(steps, printed):
    """Lists, by kind, what the steps request, and what the printed lines of a client name."""
    requests = [line.split()[1:] for line in steps if line.startswith(STEPS_WITH_REQUEST)]
    pairs = [word.partition("=")[::2] for words in requests for word in words if "=" in word]
    fields = list(
        itertools.chain.from_iterable(words[1:] for words in requests if words and words[0] in ("observe", "look"))
    )
    keys = {key for line in printed for key in re.findall(r" (\w+)=", line)}
    return {
        "command": {words[0] for words in requests if words},
        "setting": {key for key, _ in pairs},
        "preset": {value for key, value in pairs if key == "preset"},
        "choice of open": {f"{key}={value}" for key, value in pairs},
        "field": {kind_of_size(field) for field in keys},
        "encoding": {field.partition(":")[2] for field in fields},
        "error code": {line.split()[1] for line in printed if line.startswith("error ")},
    }


def missing(racebeam, steps, printed):
    """A word for each thing that is not used, such as `command open`."""
    have = usage(steps, printed)
    return [
        f"{kind} {name}" for kind, listed in expected(racebeam).items() for name in listed if name not in have[kind]
    ]


def keys_without_description(printed):
    """The keys of printed replies that protocol/protocol.toml does not have."""
    protocol = description.read()
    known = {row.name for table in (protocol.fields, protocol.settings) for row in table}
    for command in protocol.commands:
        known |= {key.removesuffix("?") for key in (*command.reply, *command.groups)}
    keys = {
        key.removeprefix("final_") for line in printed if line.startswith("ok ") for key in re.findall(r" (\w+)=", line)
    }
    return sorted(key for key in keys if kind_of_size(key) not in known and not re.fullmatch(r"grey84(x\d+)?", key))
