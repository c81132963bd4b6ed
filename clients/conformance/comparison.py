"""Runs the conformance conversation with a client, and compares what clients printed."""

import hashlib
import re
import resource
import subprocess

import servers

STEPS = servers.ROOT / "clients/conformance"
# Seconds for a conversation: a busy machine takes three times the minute of bash. ctest waits for ten minutes.
PATIENCE = 550
DESCRIPTORS = 128  # that a runner may have open: fewer than its connections, should it leak any
SECTION = re.compile(r"section (\S+)(?: like (\S+))?(?: needs (.+))?\n?$")


class Failed(Exception):
    """A runner ended with an error. The message is what it wrote."""


def steps(names, offers):
    """The lines of the files `names`, without the sections that need what a client does not offer."""
    kept = []
    for name in names:
        is_offered = True
        for line in (STEPS / name).read_text().splitlines(keepends=True):
            if found := SECTION.match(line):
                is_offered = set((found[3] or "").split()) <= set(offers)
            if is_offered:
                kept.append(line)
    return kept


def section_names(names, offers=()):
    """The sections for a client that offers this, beside TCP."""
    return {found[1] for line in steps(names, offers) if (found := SECTION.match(line))}


def run(client, names, racebeam, roms=None, **variables):
    """What `client` prints about the steps of the files, with its own servers."""
    with servers.run_servers(racebeam, roms) as places:
        path = servers.pathlib.Path(places["AUTHORITY"]).parent / "steps.txt"
        path.write_text("".join(steps(names, client.offers)))
        done = subprocess.run(
            [*client.runner, str(path)],
            env={**places, **dict(client.variables), **variables},
            capture_output=True,
            text=True,
            timeout=PATIENCE,
            preexec_fn=limit_descriptors,
        )
    if done.returncode != 0 or done.stderr:
        raise Failed(f"status {done.returncode}: {done.stderr[-2000:]}")
    return done.stdout.splitlines()


def limit_descriptors():
    resource.setrlimit(resource.RLIMIT_NOFILE, (DESCRIPTORS, DESCRIPTORS))


def sections(printed):
    """What was printed, by section."""
    found, lines = {}, []
    for line in printed:
        if line.startswith("section "):
            lines = found[line.split()[1]] = []
        else:
            lines.append(line)
    return found


def alike(names):
    """Pairs of sections that must print the same, however they ask for it."""
    lines = [line for name in names for line in (STEPS / name).read_text().splitlines()]
    return [(found[1], found[2]) for line in lines if (found := SECTION.match(line)) and found[2]]


def differences(printed, names, reference, offers):
    """A sentence for each section that is not as the reference's, or not as the section that it is like."""
    own, others = sections(printed), sections(reference)
    sections_of_client = section_names(names, offers)
    wrong = [
        difference(name, own.get(name, []), others[name])
        for name in others
        if name in sections_of_client and own.get(name) != others[name]
    ]
    for name, other in alike(names):
        if name not in sections_of_client:
            continue
        pair = [
            [line for line in own.get(section, []) if not line.startswith("ok fields=")] for section in (name, other)
        ]
        if pair[0] != pair[1]:
            wrong.append(difference(f"{name}, which is like {other}", *pair))
    return wrong


def difference(name, lines, expected):
    """The first line of a section that differs."""
    for number, (line, other) in enumerate(zip(lines + ["(nothing)"], expected + ["(nothing)"]), 1):
        if line != other:
            return f"section {name}, line {number}: printed '{line[:200]}', expected '{other[:200]}'"
    return f"section {name}: {len(lines)} lines, expected {len(expected)}"


def digest(printed, shared):
    """Returns the digest of the sections `shared`, which every client has."""
    text = "\n".join(line for name, lines in sections(printed).items() if name in shared for line in (name, *lines))
    return hashlib.sha256(text.encode()).hexdigest()[:12]
