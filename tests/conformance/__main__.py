"""Compares racebeam with ALE, frame by frame, on new random actions. docs/conformance.md says what is
compared.

Without options, all games are played: 20,000 frames in the default settings with each of two seeds, and
2,000 frames in every other setting. That takes less than an hour on two cores. Results are stored in
build/conformance; for a run that differs, also its picture and its actions. With --programs, random programs
are played instead, and only what differs is stored. Status: 0 all identical, 1 a run differs, 2 usage error,
77 nothing to compare with, 130 interrupted.
"""

import pathlib
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import reference_python  # isort: skip

reference_python.require("ale_py", "numpy")
reference_python.zero_new_memory()

import argparse
import datetime
import os
import random
import shlex
import signal

import ours
from compare import IDENTICAL, Comparison, result_of
from images import folder as image_folder
from images import games as images_of
from plan import plan
from pool import results as pool_results
from programs import KINDS as PROGRAMS
from progress import Progress
from random_programs import compare_programs
from reference import VERSION as REFERENCE_VERSION
from report import markdown
from results import Results
from run import Run

PATIENCE = 300  # seconds for one run
INTERRUPTED = 130  # the exit status


def parse_arguments():
    parser = argparse.ArgumentParser(
        prog="scripts/conformance", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    add = parser.add_argument
    add(
        "--frames", type=int, default=20000, metavar="N", help="frames of a run in the default settings (default 20000)"
    )
    add(
        "--other-frames",
        type=int,
        metavar="N",
        help="frames of a run in another setting (default 2000, or --frames if fewer)",
    )
    add("--seed", help="seed of the first series of runs; 'date': today's date (default: random, and printed)")
    add("--seeds", type=int, default=2, metavar="N", help="series in the default settings (default 2)")
    add("--games", metavar="A,B", help="only these games (default: all with an image)")
    add(
        "--settings",
        choices=["default", "sample", "all"],
        default="all",
        help="default: the default settings; sample: these, and a random one for each game; all (the default)",
    )
    add(
        "--jobs",
        type=int,
        default=os.cpu_count(),
        metavar="N",
        help="processes in parallel (default: one for each processor)",
    )
    add(
        "--programs",
        action="store_true",
        help="play random programs instead of games, for --minutes; --seed is the first",
    )
    add("--minutes", type=float, default=10, metavar="N", help="how long to play random programs (default 10)")
    add("--run", action="append", metavar="NAME", help="only this run, by its name in a report; repeatable")
    add("--resume", action="store_true", help="continue from the stored results")
    add(
        "--out",
        type=pathlib.Path,
        default=ours.SOURCE / "build/conformance",
        metavar="FOLDER",
        help="folder for results, pictures and the report (default build/conformance)",
    )
    add("--publish", action="store_true", help="also write docs/conformance.md")
    add(
        "--racebeam-options",
        default="",
        metavar="WORDS",
        help="options for racebeam only, such as --racebeam-options='--system-seed 1'",
    )
    add("--forms", action="store_true", help=f"also play each run in all variants of racebeam: {', '.join(ours.FORMS)}")
    return parser, parser.parse_args()


def base_seed(text):
    if text is None:
        return random.SystemRandom().randrange(1, 10**6)
    if text == "date":
        return int(datetime.date.today().strftime("%Y%m%d"))
    if not text.isdecimal():
        raise ValueError(f"'{text}' is not a seed: a whole number, or 'date'")
    return int(text)


def games_with_images():
    games = [game for game in images_of() if game in ours.catalogue()]
    if not games:
        print(f"skipped: no cartridge images are in {image_folder()}")
        sys.exit(reference_python.SKIPPED)
    return games


def check_games(games):
    available = games_with_images()
    for game in games:
        if game not in available:
            raise ValueError(f"no image of '{game}' was found; accepted: {', '.join(available)}")
    return games


def check_numbers(options):
    for name in ("frames", "seeds", "jobs"):
        if getattr(options, name) < 1:
            raise ValueError(f"--{name} is {getattr(options, name)}; it must be 1 or more")
    if not options.minutes > 0:
        raise ValueError(f"--minutes is {options.minutes}; it must be more than 0")


def chosen_runs(options, seeds):
    if options.run:
        runs = [Run.parse(name) for name in options.run]
        check_games([run.game for run in runs if run.game not in PROGRAMS])
        return runs, []
    other_frames = options.other_frames or min(2000, options.frames)
    games = check_games(options.games.split(",")) if options.games else games_with_images()
    return plan(games, options.settings, seeds, options.frames, other_frames)


def compare_all(runs, options, record):
    extra = shlex.split(options.racebeam_options)
    todo = [run for run in runs if run.name not in record.results]
    if len(todo) < len(runs):
        print(f"{len(runs) - len(todo)} runs are done already")
    progress = Progress(len(todo))
    forms = ours.FORMS if options.forms else ()

    def compare(run):
        return Comparison(run, options.out, extra, forms).result()

    for run, returned in pool_results(compare, todo, options.jobs, PATIENCE):
        result = result_of(run, returned)
        record.add(result)
        if result["verdict"] != IDENTICAL:
            progress.say(f"{result['run']}: {result['verdict']}: {result['report']}")
        progress.step(result["frames"], result["verdict"] == IDENTICAL)


def conclude(runs, options, record, gaps):
    """Writes the report. Returns the exit status."""
    done = [record.results[run.name] for run in runs if run.name in record.results]
    identical = sum(result["verdict"] == IDENTICAL for result in done)
    text = markdown(done, record.identity, shlex.join(["scripts/conformance", *command_line()]), gaps)
    (options.out / "conformance.md").write_text(text)
    if options.publish and len(done) == len(runs):
        (ours.SOURCE / "docs/conformance.md").write_text(text)
    frames = sum(result["frames"] for result in done)
    print(
        f"{identical} of {len(runs)} runs identical, {frames:,} frames, {len(gaps)} not comparable in part; "
        f"ale-py {record.identity['reference']}, seeds {', '.join(map(str, record.identity['seeds']))}"
    )
    return 0 if identical == len(runs) else 1


def command_line():
    """The command line as given, without options that concern this machine."""
    return [word for word in sys.argv[1:] if word not in ("--resume", "--publish")]


def prepare(options):
    """Returns the record in the folder, the runs to compare, and what is left out of them."""
    check_numbers(options)
    first = base_seed(options.seed)
    identity = {
        "version": ours.version(),
        "program": ours.digest(),
        "reference": REFERENCE_VERSION,
        "options": options.racebeam_options,
        "forms": options.forms,
        "seeds": [first + i for i in range(options.seeds)],
    }
    path = options.out / ("run.jsonl" if options.run else "results.jsonl")
    results = Results(path, identity, options.resume)
    return results, *chosen_runs(options, results.identity["seeds"])


def main():
    parser, options = parse_arguments()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.default_int_handler)
    try:
        if options.programs:
            check_numbers(options)
            return compare_programs(options, base_seed(options.seed))
        record, runs, gaps = prepare(options)
    except (ValueError, OSError) as error:
        parser.error(str(error))
    except KeyboardInterrupt:
        print("\nstopped")
        return INTERRUPTED
    try:
        compare_all(runs, options, record)
    except KeyboardInterrupt:
        print("\nstopped; scripts/conformance --resume goes on where this ended")
        conclude(runs, options, record, gaps)
        return INTERRUPTED
    return conclude(runs, options, record, gaps)


if __name__ == "__main__":
    sys.exit(main())
