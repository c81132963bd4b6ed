"""Measures what the numbers of the tuning tables are worth: each at half and at double, and each policy switched off.

The tuning tables are emulator/policies/tuning.hpp, protocol/tuning.hpp, server/tuning.hpp and system/tuning.hpp. The
program is built with the preset `tunable`, in which a row of a tuning table is a variable. A row says what it is
measured by:

  frames   games in the middle of play: the screen of every frame, and rewards only
  start    the first frames of games from power-on, in a new process each
  replies  a server on a Unix socket whose client sends requests ahead
  none     not measured: it needs many sessions, or a quiet machine

All figures are processor times, as parts of those with the usual number. The variants of a number take turns on the
same work, and the median of the turns counts: of a game, of both kinds of frames. The first row of a table compares the
usual numbers with themselves. Whatever differs by no more than that row is not known to differ.
"""

import argparse
import contextlib
import datetime
import json
import os
import re
import shlex
import statistics
import subprocess
import sys
import textwrap

import bench_sides
import cartridges
import processor
from bench_settings import SETTINGS, draw_actions

BUILD = cartridges.ROOT / "build/tunable"
TUNING_TABLES = ("emulator/policies/tuning.hpp", "protocol/tuning.hpp", "server/tuning.hpp", "system/tuning.hpp")
PAGE = cartridges.ROOT / "docs/performance/tuning.md"
GAMES = ("asteroids", "beam_rider", "breakout", "elevator_action", "pitfall2", "pong", "seaquest", "video_pinball")
CHUNK, WARM_UP = 500, 4  # frames; chunks that are not measured
AHEAD, STEPS = 64, 300  # of a client: requests under way, and requests
NEVER = 1 << 30
TABLES = "\n## The tuning tables\n"
# A policy, and the numbers that switch it off.
POLICIES = {
    "drawing frames that are not observed": {"kShortestPeriod": NEVER},
    "a second set of records for games that flicker": {"kFlickeringRows": NEVER},
    "a budget for translation": {"kCredit": NEVER, "kCapacity": NEVER},
    "interpreting where entries are short": {"kBreakEvenCycles": 0},
    "longer runs of the interpreter": {"kLongestRun": 1, "kOutsideImage": 1},
    "interpreting after steps that were too long": {"kLongestBackoff": 0},
    "trials of steps": {"kFirstPause": NEVER},
}
# Why a policy stays that saves less than 2 % in GAMES: what would happen without it, a figure without it and with it,
# and the command for the first one.
REASONS = {
    "drawing frames that are not observed": (
        "Frames are followed although most of their lines could be recalled. With frame skip 4, 108 images of ALE take "
        "1.06 of the time in the geometric mean, and from 0.96 to 1.98. 32 of them take 1.02 or more. The figure is "
        "that of Othello.",
        "1.98",
        "1.00",
        "RACEBEAM_POLICY=fixed racebeam bench --rom othello.bin --cpu translator --frame-skip 4 --screen last "
        "--frames 40000",
    ),
    "a budget for translation": (
        "A program with much code that seldom runs is translated as a whole, and breaks the bound.",
        "4.55",
        "1.54, 1.49",
        "RACEBEAM_TUNING='kCredit=1073741824 kCapacity=1073741824' translator_costs hostile 120 '64K of code'",
    ),
    "interpreting where entries are short": (
        "A program that switches banks every few instructions enters code that it leaves at once, and reaches the "
        "bound. Trials of steps find such programs later. Without trials, too, the worst takes 2.12 (600 steps).",
        "1.49, 1.55",
        "1.26, 1.28",
        "RACEBEAM_TUNING=kBreakEvenCycles=0 translator_costs hostile 120 switched",
    ),
    "interpreting after steps that were too long": (
        "A step that is too long for translated code runs twice, until trials of steps find that. The bound holds, but "
        "without trials, too, such programs take 1.58 (600 steps). Five of 108 images of ALE have such steps, in 8,000 "
        "at most 18.",
        "1.40",
        "0.88",
        "RACEBEAM_TUNING=kLongestBackoff=0 translator_costs hostile 300 overlong",
    ),
    "trials of steps": (
        "Nothing finds code that takes longer translated for another reason, such as many reads of the timer. Such a "
        "program breaks the bound, and loses the more the longer it runs.",
        "2.38",
        "1.16",
        "RACEBEAM_TUNING=kFirstPause=1073741824 translator_costs hostile 600 'storm of LDA INTIM'",
    ),
}
WHY = "\n## Why a policy that saves little stays\n"
WHY_TEXT = """
A policy that saves less than 2 % in these games stays if it saves more in others, or if the [bound
on translation](../translator.md#what-it-may-cost) needs it: a program takes at most 1.5 times its
time interpreted, and 1.5 ms more. `scripts/build --preset tunable translator_costs` makes a program
that compares the two times. The figures are those of the worst program that the command names: its
time translated, less 1.5 ms, as a part of its time interpreted. That of the first row is the time
of a game without the policy, as a part of that with it, both with `--cpu translator`.

These figures are of 2026-12-01, on an Intel Xeon with 2 processors. More than ten other programs
used them, so that differences of less than a tenth are noise, also from the bound.

"""
INTRODUCTION = """\
A policy makes choices that affect only speed, by numbers such as how much time a machine may spend
on translation. This page shows what the policies gain, and what happens to the time if a number is
half or double its value. `scripts/bench tune --write` writes the page, so do not edit it;
`scripts/bench tune --help` says how the figures are measured.

Figures are processor times, as parts of those with the usual numbers: 1.010 takes 1 % longer. For
each setting, there is the geometric mean of the games, and the game with the highest figure. Tables
are named by what was measured: `frames` are games in the middle of play, `start` are their first
frames from power-on, and `replies` are those of a server to requests that were sent ahead.

Other programs used the machine during the run. The row `the usual numbers` compares these with
themselves, so differences that are not larger are noise.
"""
ROW = re.compile(
    r"((?: *// .*\n)+)RACEBEAM_TUNED\((?P<type>[\w:]+), (?P<name>k\w+), (?P<value>[\d']+), "
    r'"(?P<unit>[^"]+)", "(?P<measure>\w+)"\);'
)


def read_tuning_table(file):
    """The rows of a tuning table as dictionaries, in their order."""
    found = []
    for match in ROW.finditer((cartridges.ROOT / file).read_text()):
        meaning = " ".join(line.strip().removeprefix("// ") for line in match[1].splitlines())
        value = int(match["value"].replace("'", ""))
        found.append({**match.groupdict(), "file": file, "value": value, "meaning": meaning})
    return found


def parse_arguments(rows):
    parser = argparse.ArgumentParser(
        prog="scripts/bench tune", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("names", nargs="*", metavar="NAME", help="rows of the tuning tables (default: all)")
    parser.add_argument("--games", nargs="+", default=GAMES, metavar="GAME", help=f"default: {' '.join(GAMES)}")
    parser.add_argument(
        "--chunks", type=int, default=12, metavar="N", help=f"measured chunks, of {CHUNK} frames each (default 12)"
    )
    parser.add_argument("--first", type=int, default=300, metavar="N", help="first frames, for `start` (default 300)")
    parser.add_argument(
        "--rounds", type=int, default=7, metavar="N", help="repetitions of `start` and `replies` (default 7)"
    )
    parser.add_argument("--by", nargs="+", choices=MEASURES, default=[*MEASURES], help="measure only these rows")
    parser.add_argument("--write", action="store_true", help=f"write {PAGE.relative_to(cartridges.ROOT)}")
    parser.add_argument(
        "--tables", action="store_true", help="only write the tables of that page anew; measure nothing"
    )
    options = parser.parse_args()
    unknown = set(options.names) - {row["name"] for row in rows}
    if unknown:
        parser.error(
            f"no tuning table has a row {', '.join(sorted(unknown))}; rows are {', '.join(r['name'] for r in rows)}"
        )
    if options.write and options.names:
        parser.error("--write needs all rows, so that NAME cannot be given")
    if options.tables and (options.write or options.names):
        parser.error("--tables measures nothing, so that neither NAME nor --write can be given")
    return options


def variable(values):
    """The environment of a program with other numbers."""
    return {"RACEBEAM_TUNING": " ".join(f"{name}={value}" for name, value in values.items())}


def ratios(times):
    """The time of each variant as a part of the first one's: the median of the turns. times: a row a turn."""
    return [statistics.median(turn[i] / turn[0] for turn in times) for i in range(len(times[0]))]


def time_frames(game, variants, options):
    """Returns the time of each variant as a part of the first one's, in the geometric mean of both settings."""
    found = []
    for setting in (SETTINGS["every"], SETTINGS["none"]):
        actions = draw_actions(game, range(18), (WARM_UP + options.chunks) * CHUNK)
        times = []
        with contextlib.ExitStack() as stack:
            sides = [
                stack.enter_context(bench_sides.Racebeam(game, setting, environment=variable(values)))
                for values in variants
            ]
            for first in range(0, len(actions), CHUNK):
                chunk = "play " + " ".join(map(str, actions[first : first + CHUNK]))
                times.append([side.ask(chunk)["seconds"] for side in sides])
        found.append(ratios(times[WARM_UP:]))
    return [statistics.geometric_mean(both) for both in zip(*found)]


def time_start(game, variants, options):
    chunk = "play " + " ".join(map(str, draw_actions(game, range(18), options.first)))
    times = []
    for _ in range(options.rounds):
        turn = []
        for values in variants:
            with bench_sides.Racebeam(game, SETTINGS["every"], environment=variable(values)) as side:
                turn.append(side.ask(chunk)["seconds"])
        times.append(turn)
    return ratios(times)


def time_replies(game, variants, options):
    times = []
    for _ in range(options.rounds):
        turn = []
        for values in variants:
            command = [BUILD / "tests/server/wire_bench", BUILD / "racebeam", cartridges.image(game)]
            done = subprocess.run(
                [*command, str(STEPS), str(AHEAD)], capture_output=True, check=True, env=os.environ | variable(values)
            )
            turn.append(json.loads(done.stdout)["unix"]["microseconds"])
        times.append(turn)
    return ratios(times)


MEASURES = {"frames": time_frames, "start": time_start, "replies": time_replies}


def measure(by, variants, options):
    """(geometric mean, greatest, its game) of each variant but the first."""
    games = options.games[:1] if by == "replies" else options.games
    of_games = [MEASURES[by](game, variants, options) for game in games]
    found = []
    for i in range(1, len(variants)):
        figures = [ratios_of_game[i] for ratios_of_game in of_games]
        greatest = max(figures)
        found.append((statistics.geometric_mean(figures), greatest, games[figures.index(greatest)]))
    return found


def cells(figures):
    return [part for mean, most, game in figures for part in (f"{mean:.3f}", f"{most:.3f} ({game})")]


def line(words):
    return "| " + " | ".join(words) + " |\n"


def table(headings, rows):
    words = (headings[0], "unit", "measured by", "meaning")
    return line(headings) + line(["---" if name in words else "---:" for name in headings]) + "".join(map(line, rows))


def measured_rows(by, rows, options):
    """Yields the lines of a table: the usual numbers, then each row."""
    yield ["the usual numbers", "", "", *cells(measure(by, [{}, {}, {}], options))]
    for row in rows:
        variants = [{}, {row["name"]: row["value"] // 2}, {row["name"]: 2 * row["value"]}]
        yield [f"`{row['name']}`", f"{row['value']:,}", row["unit"], *cells(measure(by, variants, options))]


def policy_rows(options):
    for name, values in POLICIES.items():
        yield [name, *(cell for by in ("frames", "start") for cell in cells(measure(by, [{}, values], options)))]


def reasons():
    """The part of the page that says why policies stay."""
    lines = [[*words[:-1], f"`{words[-1]}`"] for words in ([name, *reason] for name, reason in REASONS.items())]
    headings = ["policy", "what happens without it", "without", "with", "command"]
    kinds = ["---", "---", "---:", "---:", "---"]
    return WHY + WHY_TEXT + "".join(map(line, [headings, kinds, *lines]))


def tuning_table_part(file, rows):
    words = [[f"`{row['name']}`", f"{row['value']:,}", row["unit"], row["measure"], row["meaning"]] for row in rows]
    return f"\n### {file}\n\n" + table(["number", "value", "unit", "measured by", "meaning"], words)


def page(tables, policies, rows, options):
    facts = [
        ("command", f"`{shlex.join(['scripts/bench', 'tune', *sys.argv[1:]])}`"),
        ("date", datetime.date.today().isoformat()),
        ("processor", f"{processor.name()}, {os.cpu_count()} processors"),
        ("games", ", ".join(options.games)),
        ("frames", f"{options.chunks * CHUNK:,} of a game in each setting; the first {options.first} for `start`"),
    ]
    text = "# What the numbers of the policies are worth\n\n" + INTRODUCTION + "\n"
    text += table(["run", "value"], facts).replace("---:", "---")
    text += "\n## A policy switched off\n\n"
    text += table(["policy", "frames: mean", "most", "start: mean", "most"], policies)
    text += reasons()
    for by, lines in tables.items():
        if not lines:
            continue
        text += f"\n## Half and double, by `{by}`\n\n"
        text += table(["number", "value", "unit", "half: mean", "most", "double: mean", "most"], lines)
    return text + tuning_tables(rows, measured={line[0] for lines in tables.values() for line in lines})


def tuning_tables(rows, measured):
    """The end of the page: the rows, and which of them the run did not measure."""
    text = TABLES + "\nThe meanings are the comments of the sources.\n"
    missing = [f"`{row['name']}`" for row in rows if row["measure"] in MEASURES and f"`{row['name']}`" not in measured]
    if missing:
        text += "\n" + textwrap.fill(f"This run did not measure {', '.join(missing)}.", 100) + "\n"
    for file in TUNING_TABLES:
        text += tuning_table_part(file, [row for row in rows if row["file"] == file])
    return text


def with_tuning_tables(page, rows):
    """The page with the rows and reasons as they are now. Its figures stay, but those of numbers that no table has."""
    names = {f"`{row['name']}`" for row in rows}
    lines = page.partition(TABLES)[0].splitlines(keepends=True)
    named = [re.match(r"\| (`k\w+`) \|", line) for line in lines]
    kept = "".join(line for line, name in zip(lines, named) if not name or name[1] in names)
    before, why, rest = kept.partition(WHY)
    kept = before + reasons() + rest[rest.index("\n## ") :] if why else kept
    return kept + tuning_tables(rows, measured={name[1] for name in named if name})


def main():
    rows = [row for file in TUNING_TABLES for row in read_tuning_table(file)]
    options = parse_arguments(rows)
    if options.tables:
        PAGE.write_text(with_tuning_tables(PAGE.read_text(), rows))
        return
    bench_sides.RACEBEAM = os.environ.get("RACEBEAM_BINARY", str(BUILD / "racebeam"))
    chosen = [row for row in rows if row["name"] in options.names or not options.names]
    policies, tables = [], {by: [] for by in options.by}

    def add(lines, line):
        lines.append(line)
        print(" ".join(line), flush=True)
        if options.write:  # now, so that a run that is stopped leaves what it has measured
            PAGE.write_text(page(tables, policies, rows, options))

    try:
        for line in [] if options.names else policy_rows(options):
            add(policies, line)
        for by in options.by:
            of_measure = [row for row in chosen if row["measure"] == by]
            for line in measured_rows(by, of_measure, options) if of_measure else []:
                add(tables[by], line)
    except LookupError as error:
        sys.exit(f"bench: {error}")


if __name__ == "__main__":
    main()
