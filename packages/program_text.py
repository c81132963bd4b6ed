#!/usr/bin/env python3
"""Writes the man pages of racebeam, and the completions of its command line for bash, zsh and fish, from its help
texts.

usage: program_text.py FOLDER PROGRAM...    (several words where an emulator runs it)
"""

import os
import pathlib
import re
import subprocess
import sys

OPTION = re.compile(r"^  (?:-\w,)?(--[\w-]+)(.*)$", re.MULTILINE)
SUBCOMMAND = re.compile(r"^  (\w+) {2,}(.+)$", re.MULTILINE)
PROTOCOL = "racebeam-protocol"  # a page of section 7, from the description of the protocol
MACHINE = re.compile(r"(--threads INT|--max-memory UINT)=\d+")  # defaults that depend on the machine
GAMES = "racebeam games 2>/dev/null | awk 'NR > 1 { print $1 }'"
FILES = {
    "--rom",
    "--game-file",
    "--token-file",
    "--tls-cert",
    "--tls-key",
    "--config",
    "--ready-file",
    "--authorities",
    "--roms",
    "--record-dir",
}


def help_of(program, *words):
    """A help text, in the width of a page, whatever the environment says."""
    plain = {key: value for key, value in os.environ.items() if not key.startswith("RACEBEAM_")}
    text = subprocess.run([*program, *words, "--help"], capture_output=True, text=True, check=True, env=plain).stdout
    return MACHINE.sub(r"\1", text)


def subcommands(text):
    """Names and summaries."""
    return dict(SUBCOMMAND.findall(text.partition("Subcommands:")[2].partition("\n\n")[0]))


def options(text):
    """The long options of a help text: whether each takes a value."""
    return {name: bool(re.match(r" (?! )\S", rest)) for name, rest in OPTION.findall(text)}


def roff(text):
    """Text as it is, for man."""
    return re.sub(r"^([.'])", r"\\&\1", text.replace("\\", r"\e").replace("-", r"\-"), flags=re.MULTILINE)


def man_page(name, text, version, summary, others):
    """A page: what the help says, in the order in which it says it."""
    lines = [f'.TH {name.upper()} 1 "" "racebeam {version}"', ".SH NAME", f"{roff(name)} \\- {roff(summary)}"]
    _, _, rest = text.partition("Usage: ")
    usage, _, rest = rest.partition("\n")
    lines += [".SH SYNOPSIS", f".B {roff(usage)}", ".SH DESCRIPTION", ".nf", roff(rest.strip("\n")), ".fi"]
    lines += [".SH SEE ALSO", ",\n".join(f".BR {roff(other)} ({7 if other == PROTOCOL else 1})" for other in others)]
    return "\n".join(lines) + "\n"


def bash(commands):
    cases = "\n".join(f"    {name}) options='{' '.join(found)}' ;;" for name, found in commands.items())
    return f"""# Completion of racebeam for bash.
_racebeam() {{
  local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD-1]}} options=
  if ((COMP_CWORD == 1)); then
    COMPREPLY=($(compgen -W '{" ".join(commands)} --help --version' -- "$word"))
    return
  fi
  case $before in
    --game) COMPREPLY=($(compgen -W "$({GAMES})" -- "$word")); return ;;
    {"|".join(sorted(FILES))}) compopt -o default; COMPREPLY=(); return ;;
  esac
  case ${{COMP_WORDS[1]}} in
{cases}
  esac
  case $word in
    -*) COMPREPLY=($(compgen -W "$options" -- "$word")) ;;
    *) compopt -o default; COMPREPLY=() ;;
  esac
}}
complete -F _racebeam racebeam
"""


def zsh(commands, summaries):
    cases = "\n".join(f"    {name}) options=({' '.join(found)}) ;;" for name, found in commands.items())
    described = "\n".join(f"    '{name}:{summaries[name].replace(chr(39), '')}'" for name in commands)
    return f"""#compdef racebeam
# Completion of racebeam for zsh.
_racebeam() {{
  local -a options commands
  commands=(
{described}
  )
  if ((CURRENT == 2)); then
    _describe command commands
    return
  fi
  case $words[CURRENT-1] in
    --game) compadd -- ${{(f)"$({GAMES})"}}; return ;;
    {"|".join(sorted(FILES))}) _files; return ;;
  esac
  case $words[2] in
{cases}
  esac
  if [[ $words[CURRENT] == -* ]]; then
    compadd -- $options
  else
    _files
  fi
}}
_racebeam "$@"
"""


def fish(commands, summaries):
    lines = ["# Completion of racebeam for fish."]
    for name, found in commands.items():
        about = summaries[name].replace("'", "")
        lines.append(f"complete -c racebeam -n __fish_use_subcommand -f -a {name} -d '{about}'")
        for option, takes_value in found.items():
            values = (
                f" -x -a '({GAMES.replace(chr(39), chr(34)).replace('$1', chr(92) + '$1')})'"
                if option == "--game"
                else " -r"
                if takes_value
                else ""
            )
            lines.append(f"complete -c racebeam -n '__fish_seen_subcommand_from {name}' -l {option[2:]}{values}")
    return "\n".join(lines) + "\n"


def main():
    folder, program = pathlib.Path(sys.argv[1]), sys.argv[2:]
    version = subprocess.run([*program, "--version"], capture_output=True, text=True, check=True).stdout.split()[1]
    about = help_of(program)
    summaries = subcommands(about)
    texts = {name: help_of(program, name) for name in summaries}
    commands = {name: options(text) for name, text in texts.items()}
    pages = [*(f"racebeam-{name}" for name in summaries), PROTOCOL]
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "racebeam.1").write_text(man_page("racebeam", about, version, about.partition("\n")[0], pages))
    for name, text in texts.items():
        (folder / f"racebeam-{name}.1").write_text(
            man_page(f"racebeam-{name}", text, version, summaries[name], ["racebeam", PROTOCOL])
        )
    (folder / "racebeam.bash").write_text(bash(commands))
    (folder / "_racebeam").write_text(zsh(commands, summaries))
    (folder / "racebeam.fish").write_text(fish(commands, summaries))


if __name__ == "__main__":
    main()
