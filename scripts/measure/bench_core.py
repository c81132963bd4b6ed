"""Measures racebeam and ALE, game by game, and checks in the same run that both do the same.

Settings:
  every    the screen and RAM of every frame
  last     frame skip 4, the screen of the last frame
  none     rewards and RAM only (ALE draws nevertheless: it cannot avoid that)
  states   a reset, and a state saved and restored

Each side is a process. Both are pinned to one processor, and play chunks of the same random legal actions. They take
turns, so that other work of the machine disturbs both. The processor time of the acts is measured, without resets. A
setting begins with two chunks that are not measured: they fill caches and translate code.

The ratio of a game is the median of its chunks' ratios. Both sides of a chunk do the same work within a moment,
so that a ratio is right even if the machine's speed drifts. A disturbance affects a few chunks, which a median
ignores and a mean would not. The best times of both sides would come from different scenes of the game.

After each timed chunk, the script compares frames, rewards, resets, RAM and (if observed) the screen. Then it plays the
same actions again on new machines, without timing them. It compares a checksum of screen, RAM, reward, end and lives
after every act. A game that differs has no figures, and the run fails; scripts/conformance locates the difference.
"""

import argparse
import datetime
import json
import pathlib
import shlex
import statistics
import sys
import time

import bench_report
import bench_sides
import cartridges
from bench_settings import SETTINGS, draw_actions

QUICK_GAMES = ["breakout", "pong", "qbert", "seaquest", "space_invaders"]
CHUNK = 500  # frames
WARM_UP = 2  # chunks that are not measured
STATES = "states"
ROUNDS, RESETS, SNAPSHOTS = 5, 4, 200  # per round: resets, saved states


def parse_arguments():
    parser = argparse.ArgumentParser(
        prog="scripts/bench core", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--games", nargs="+", metavar="GAME", help="default: all games that the reference can play")
    parser.add_argument("--frames", type=int, metavar="N", help="measured frames of a game in a setting (default 8000)")
    parser.add_argument("--settings", nargs="+", choices=[*SETTINGS, STATES], default=[*SETTINGS, STATES])
    parser.add_argument(
        "--cpu",
        choices=["auto", "interpreter", "translator"],
        help="how instructions are executed (passed to racebeam bench)",
    )
    parser.add_argument("--quick", action="store_true", help="only 4000 frames of five games: " + " ".join(QUICK_GAMES))
    parser.add_argument(
        "--out",
        type=pathlib.Path,
        default=cartridges.ROOT / "build/bench/core.json",
        metavar="FILE",
        help="file for all figures, as JSON (default build/bench/core.json)",
    )
    parser.add_argument(
        "--write",
        action="store_true",
        help="write docs/performance/figures.md and its picture, and the summary in docs/performance.md",
    )
    parser.add_argument(
        "--from",
        dest="source",
        type=pathlib.Path,
        metavar="FILE",
        help="measure nothing, and read the figures from this file",
    )
    options = parser.parse_args()
    options.games = options.games or (QUICK_GAMES if options.quick else cartridges.games())
    options.frames = options.frames or (4000 if options.quick else 8000)
    if options.frames < CHUNK:
        parser.error(f"--frames {options.frames}: it must be at least {CHUNK}, a chunk")
    return options


def draw_chunks(game, legal_actions, chunks, acts):
    actions = draw_actions(game, legal_actions, chunks * acts)
    return [" ".join(map(str, actions[start : start + acts])) for start in range(0, len(actions), acts)]


class Difference(Exception):
    pass


def must_agree(game, where, theirs, ours, keys):
    for key in keys:
        if theirs.get(key) != ours.get(key):
            raise Difference(
                f"{game} differs from the reference in {where}: {key} {theirs.get(key)} there, "
                f"{ours.get(key)} here; scripts/conformance --games {game} shows more"
            )


def both_open(reference, game, setting, cpu):
    return reference.open(game, setting), bench_sides.Racebeam(game, setting, cpu)


def time_chunks(reference, game, name, options):
    """Returns [seconds of ALE, seconds of racebeam, frames] of each chunk, and the actions that were played."""
    setting = SETTINGS[name]
    opened, racebeam = both_open(reference, game, setting, options.cpu)
    chunks = draw_chunks(game, opened["legal_actions"], WARM_UP + options.frames // CHUNK, CHUNK // setting.skip)
    times = []
    with racebeam:
        for number, actions in enumerate(chunks, 1):
            theirs, ours = reference.ask("play " + actions), racebeam.ask("play " + actions)
            must_agree(
                game,
                f"setting {name}, after chunk {number}",
                theirs,
                ours,
                ("frames", "reward", "resets", "screen", "ram"),
            )
            times.append([theirs["seconds"], ours["seconds"], ours["frames"]])
    return times[WARM_UP:], chunks


def check_chunks(reference, game, name, chunks, options):
    _, racebeam = both_open(reference, game, SETTINGS[name], options.cpu)
    with racebeam:
        for number, actions in enumerate(chunks, 1):
            racebeam.send("check " + actions)
            theirs, ours = reference.ask("check " + actions), racebeam.answer()
            must_agree(
                game, f"setting {name}, within chunk {number}", theirs, ours, ("digest", "frames", "reward", "resets")
            )


def measure_setting(reference, game, name, options):
    times, chunks = time_chunks(reference, game, name, options)
    check_chunks(reference, game, name, chunks, options)
    ratios = [theirs / ours for theirs, ours, _ in times]
    low, _, high = statistics.quantiles(ratios, n=4) if len(ratios) > 1 else ratios * 3
    return {
        "ale_frames_per_second": statistics.median(frames / theirs for theirs, _, frames in times),
        "racebeam_frames_per_second": statistics.median(frames / ours for _, ours, frames in times),
        "ratio": statistics.median(ratios),
        "quartiles": [low, high],
        "frames_checked": sum(frames for _, _, frames in times),
        "chunks": times,
    }


def measure_states(reference, game, options):
    setting = SETTINGS["every"]
    opened, racebeam = both_open(reference, game, setting, options.cpu)
    first_actions, after = draw_chunks(game, opened["legal_actions"], 2, CHUNK)
    resets, saves = [], []
    with racebeam:

        def both(command):
            return (reference.ask(command), racebeam.ask(command))

        both("play " + first_actions)
        for number in range(1, ROUNDS + 1):
            theirs, ours = both(f"reset {RESETS}")
            must_agree(game, f"setting {STATES}, after reset {number * RESETS}", theirs, ours, ("screen", "ram"))
            resets.append((theirs["seconds"], ours["seconds"]))
        both("play " + first_actions)
        for _ in range(ROUNDS):
            theirs, ours = both(f"save {SNAPSHOTS}")
            saves.append((theirs["seconds"], ours["seconds"], ours["machine_seconds"]))
        must_agree(game, f"setting {STATES}, after its snapshots", *both("check " + after), ("digest",))

    def median(rows, column):
        return statistics.median(row[column] for row in rows)

    return {
        "ale_reset_ms": median(resets, 0) * 1e3,
        "racebeam_reset_ms": median(resets, 1) * 1e3,
        "reset_ratio": statistics.median(theirs / ours for theirs, ours in resets),
        "ale_save_restore_ns": median(saves, 0) * 1e9,
        "racebeam_save_restore_ns": median(saves, 1) * 1e9,
        "machine_save_restore_ns": median(saves, 2) * 1e9,
        "save_restore_ratio": statistics.median(theirs / ours for theirs, ours, _ in saves),
    }


def in_short(results):
    parts = [f"{name} {results[name]['ratio']:.2f}" for name in SETTINGS if name in results]
    if STATES in results:
        states = results[STATES]
        parts.append(f"reset {states['reset_ratio']:.2f}, save and restore {states['save_restore_ratio']:.0f}")
    return ", ".join(parts)


def measure_game(reference, game, options):
    found = {name: measure_setting(reference, game, name, options) for name in SETTINGS if name in options.settings}
    if STATES in options.settings:
        found[STATES] = measure_states(reference, game, options)
    return found


def measure(options):
    games, differences, start = {}, [], time.monotonic()
    with bench_sides.Reference() as reference:
        for number, game in enumerate(options.games, 1):
            try:
                games[game] = measure_game(reference, game, options)
                line = f"{game}: {in_short(games[game])}"
            except Difference as difference:
                differences.append(str(difference))
                line = differences[-1]
            seconds = time.monotonic() - start
            print(f"{number}/{len(options.games)} {seconds:.0f} s  {line}", file=sys.stderr, flush=True)
    return {
        "command": shlex.join(["scripts/bench", "core", *sys.argv[1:]]),
        "date": datetime.date.today().isoformat(),
        "seconds": round(time.monotonic() - start),
        "machine": bench_report.machine(),
        "versions": bench_report.versions(bench_sides.RACEBEAM),
        "frames": options.frames // CHUNK * CHUNK,
        "chunk_frames": CHUNK,
        "games": games,
        "differences": differences,
    }


def main():
    options = parse_arguments()
    try:
        results = json.loads(options.source.read_text()) if options.source else measure(options)
    except (LookupError, OSError) as error:
        sys.exit(f"bench: {error}")
    if not options.source:
        options.out.parent.mkdir(parents=True, exist_ok=True)
        options.out.write_text(json.dumps(results, indent=1) + "\n")
    if results["games"]:
        print(bench_report.page(results))
    if results["differences"]:
        sys.exit("bench: " + "\nbench: ".join(results["differences"]))
    if options.write:
        bench_report.write(results)


if __name__ == "__main__":
    main()
