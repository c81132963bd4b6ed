"""Runs the examples of the documents and compares what they print.

An example is a block fenced as ```console. Its lines that begin with "$ " are commands, run by bash with racebeam in
the PATH, in a new folder that all examples of a document share; a line that ends in a backslash goes on in the next,
and so does a command until its here-document ends. The other lines are what the command before them prints, standard
error included; "..." stands for any text within a line, and on its own line for any lines. Blocks fenced otherwise
(```sh) are not run.
"""

import os
import re
import subprocess
import sys
import tempfile

from tree import documents

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
BINARY = os.environ.get("RACEBEAM_BINARY", os.path.join(SOURCE, "build", "release", "racebeam"))


HERE_DOCUMENT = re.compile(r"<<'(\w+)'")


def is_unfinished(command):
    """Whether the next line is part of the command: after a backslash, or inside a here-document."""
    here = HERE_DOCUMENT.search(command)
    return command.endswith("\\") or (here is not None and not command.endswith("\n" + here[1]))


def examples(text, fence="console"):
    """(line number, command, expected lines) of every command in the blocks with this fence."""
    found, inside = [], False
    for number, line in enumerate(text.splitlines(), 1):
        if line.startswith("```"):
            inside = line.strip() == f"```{fence}"
        elif inside and line.startswith("$ "):
            found.append((number, line[2:], []))
        elif inside and found and is_unfinished(found[-1][1]) and not found[-1][2]:
            found[-1] = (found[-1][0], found[-1][1] + "\n" + line, [])
        elif inside and found:
            found[-1][2].append(line)
    return found


def pattern(lines):
    """A regular expression for the expected output."""
    parts = []
    for line in lines:
        if line == "...":
            parts.append(r"(?:.*\n)*?")
        else:
            parts.append(".*?".join(re.escape(piece) for piece in line.split("...")) + r"\n")
    return re.compile("".join(parts))


def run(command, folder, binary):
    environment = dict(os.environ, PATH=os.path.dirname(binary) + os.pathsep + os.environ["PATH"])
    done = subprocess.run(
        ["bash", "-c", command],
        cwd=folder,
        env=environment,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        timeout=120,
    )
    return done.stdout


def check(name, fence="console", binary=BINARY):
    """Returns the number of examples of a document, and of those whose output differs from it.

    `binary` is the program that the examples run."""
    with open(os.path.join(SOURCE, name)) as file:
        found = examples(file.read(), fence)
    wrong = 0
    with tempfile.TemporaryDirectory() as folder:
        for number, command, expected in found:
            output = run(command, folder, binary)
            if not pattern(expected).fullmatch(output):
                wrong += 1
                print(f"{name}:{number}: $ {command}\nexpected:\n" + "\n".join(expected) + f"\nprinted:\n{output}")
    return len(found), wrong


def main():
    counts = [check(str(path)) for path in documents()]
    ran, wrong = (sum(column) for column in zip(*counts))
    print(f"{ran} examples in {len(counts)} documents, {wrong} wrong")
    return 1 if wrong or not ran else 0


if __name__ == "__main__":
    sys.exit(main())
