"""Counts the instructions of a frame under valgrind, by part of the machine.

Instructions are not time, but they are the same in every run. All 18 actions are played randomly. The frames
before the counted ones fill caches and translate code. Policies that read clocks are fixed (RACEBEAM_POLICY=fixed): all
code is translated, and frames that are not observed are followed. The program is built with the preset `profile`
(build/profile), which is `release` with line numbers.
"""

import argparse
import re
import sys

import bench_settings
import callgrind
import cartridges

# A part of the machine, and a pattern for its files. The first pattern that matches counts.
PARTS = (
    ("CPU, translated code", re.escape(callgrind.MADE_AT_RUN_TIME)),
    ("CPU, translator", r"emulator/translator/(?!bus_calls)"),
    ("CPU, interpreter", r"emulator/(cpu/|base/(opcodes|inlining)\b)"),
    ("TIA, log and registers", r"emulator/(tia/(tia\b|register_effects|registers/)|base/vectors\b)"),
    ("TIA, lines and pixels", r"emulator/tia/(?!sound\b)"),
    ("sound", r"emulator/tia/sound\b"),
    ("bus, cartridge, RIOT", r"emulator/"),
    ("rules", r"games/"),
    ("environment", r"environment/"),
    ("the measurement", r"cli/"),
    ("libraries", r""),
)
WIDEST = 80  # characters of a function's name


def parse_arguments():
    parser = argparse.ArgumentParser(
        prog="scripts/bench profile", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("game", metavar="GAME")
    parser.add_argument("--frames", type=int, default=120, metavar="N", help="counted frames (default 120)")
    parser.add_argument("--before", type=int, default=600, metavar="N", help="frames before them (default 600)")
    parser.add_argument(
        "--setting",
        choices=bench_settings.SETTINGS,
        default="every",
        help="one setting, as in scripts/bench core (default every)",
    )
    parser.add_argument(
        "--cpu",
        choices=["auto", "interpreter", "translator"],
        help="how instructions are executed (passed to racebeam bench)",
    )
    parser.add_argument("--files", action="store_true", help="also print source files")
    parser.add_argument(
        "--functions", type=int, default=0, metavar="N", help="also print the N functions with the most instructions"
    )
    options = parser.parse_args()
    if min(options.frames, options.before) < 4:
        parser.error("--frames and --before must be at least 4")
    return options


def by_part(counts):
    parts = dict.fromkeys((part for part, _ in PARTS), 0)
    for file, cost in counts.files.items():
        parts[next(part for part, pattern in PARTS if re.match(pattern, file))] += cost
    return parts


def print_table(heading, rows, counts):
    width = min(max(len(label) for label, _ in rows), WIDEST)
    print(f"\n{heading:<{width}} instructions a frame  share")
    for label, cost in rows:
        print(f"{label[:width]:<{width}} {cost / counts.frames:>20,.0f} {cost / counts.total:>5.1%}")


def main():
    options = parse_arguments()
    setting = bench_settings.SETTINGS[options.setting]
    if not callgrind.available():
        sys.exit("bench: valgrind is missing; scripts/setup installs it")
    try:
        # With all the SIMD that this processor has, as in measurements, but without policies that read clocks.
        counts = callgrind.count(
            cartridges.ROOT / "build/profile/racebeam",
            options.game,
            setting,
            options.before,
            options.frames,
            options.cpu,
            environment={"RACEBEAM_POLICY": "fixed"},
        )
    except (LookupError, RuntimeError) as error:
        sys.exit(f"bench: {error}")
    print(
        f"{options.game}, {setting.heading.lower()}: {counts.a_frame():,.0f} instructions a frame, "
        f"in the mean of {counts.frames} frames after {options.before}"
    )
    print_table("part", [row for row in by_part(counts).items() if row[1]], counts)
    if options.files:
        print_table("file", counts.files.most_common(), counts)
    if options.functions:
        print_table("function", counts.functions.most_common(options.functions), counts)


if __name__ == "__main__":
    main()
