"""The completion of requests for the client in bash."""

import re

PATH = "clients/shell/completion.bash"
TEXT = r"""# Completion of requests for bash at a terminal, after racebeam.bash:
#
#   source racebeam.bash; source completion.bash
#   racebeam_ask load beamfall life_loss=<Tab>
#
# Made from protocol/protocol.toml by protocol/description/generate. Do not change it by hand.

# What may follow each command. `=` at the end: a value follows.
declare -rA _racebeam_follows=(
{follows})
readonly _racebeam_field_words='{fields}' _racebeam_encoding_words='{encodings}'

_racebeam_complete() {
  local typed=${COMP_LINE:0:COMP_POINT} word words one before
  word=${typed##* }
  read -ra words <<<"${typed% *}"
  COMPREPLY=()
  if ((${#words[@]} == 1)); then
    mapfile -t COMPREPLY < <(compgen -W "${!_racebeam_follows[*]}" -- "$word")
  elif [[ $word == *:* ]]; then
    mapfile -t COMPREPLY < <(compgen -P "${word%:*}:" -W "$_racebeam_encoding_words" -- "${word##*:}")
  else
    for one in ${_racebeam_follows[${words[1]}]-}; do
      [[ $one == FIELD ]] && one=$_racebeam_field_words
      mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -W "$one" -- "$word")
    done
  fi
  [[ ${#COMPREPLY[@]} == 1 && ${COMPREPLY[0]} == *= ]] && compopt -o nospace 2>/dev/null
  before=${word%"${word##*["$COMP_WORDBREAKS"]}"}  # bash replaces what follows the last sign that breaks words
  COMPREPLY=("${COMPREPLY[@]#"$before"}")
}
complete -F _racebeam_complete racebeam_ask racebeam_send
"""


def of_key(key, values):
    return [f"{key}={value}" for value in values] or [f"{key}="]


def alternatives(text):
    """The alternatives in small letters or digits, such as none in FIELD[:ENCODING]...|none."""
    return [one for one in re.sub(r"\[[^\]]*\]|\.", "", text).split("|") if re.fullmatch("[a-z0-9-]+", one)]


def words_of(command, protocol):
    presets = [preset.name for preset in protocol.presets]
    for argument in command.arguments:
        if argument.type == "settings":
            for setting in protocol.settings:
                if not setting.deprecated:
                    yield from of_key(setting.name, presets if setting.name == "preset" else setting.values)
        elif argument.key:
            yield from of_key(argument.key, argument.choices or alternatives(argument.text))
        else:
            yield from ["FIELD"] * (argument.type == "fields") + alternatives(argument.text)
            if argument.type == "actions":
                yield from (*protocol.joystick, *protocol.console)


def follows(protocol):
    for command in protocol.commands:
        if command.name == "help":
            rows = (protocol.commands, protocol.settings, protocol.presets, protocol.fields, protocol.encodings)
            names = [row.name for table in rows for row in table if not row.deprecated]
            names += [row.code for row in protocol.errors]
            words = alternatives(command.arguments[0].text) + names
        else:
            words = list(words_of(command, protocol))
        yield f"  [{command.name}]='{' '.join(dict.fromkeys(words))}'\n"


def files(protocol, _):
    fields = [field.name for field in protocol.fields if not field.deprecated]
    text = TEXT.replace("{follows}", "".join(follows(protocol))).replace("{fields}", " ".join(fields))
    return {PATH: text.replace("{encodings}", " ".join(row.name for row in protocol.encodings))}
