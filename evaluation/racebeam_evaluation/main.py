"""The program racebeam-evaluate."""

import argparse
import pathlib
import sys

from .board.site import build
from .bootstrap import Bootstrap
from .errors import BadInput, printable
from .load import read_all
from .output.folder import check_free, write
from .output.report import Report
from .reports import benchmark, machado2018, paper2013
from .reports.paper_report import evaluate_paper

_REPORTS = {
    "paper2013": paper2013.evaluate,
    "machado2018": machado2018.evaluate,
    "atari100k": benchmark.atari100k,
    "atari57": benchmark.atari57,
}
_DEFAULT_REPORT = "paper2013"

_EPILOG = """\
The exit status is 0 if all could be computed, 1 for bad input (nothing is then written), 2 for a usage error, and 3 if
the report is written but tests could not be made, or a submission cannot be shown, each of which standard error names.
docs/evaluation.md explains the report."""


def main(arguments: list[str] | None = None) -> int:
    """Does what `arguments`, else the command line, ask for. Returns the exit status."""
    parser = _parser()
    options = parser.parse_args(arguments)
    if options.paper == bool(options.results):
        parser.error("expected RESULTS, or --paper")
    if options.board and not options.results:
        parser.error("expected folders of submissions for --board")
    _refuse_ignored(parser, options)
    try:
        check_free(options.into)
        if options.board:
            return _write_board(options)
        report = _report(options)
        write(options.into, report.files())
    except BadInput as error:
        _complain(str(error))
        return 1
    for sentence in report.untested:
        _complain(sentence)
    print(f"{len(report.parts)} tables and figures: {options.into / 'report.md'}")
    return 3 if report.untested else 0


def _complain(sentence: str) -> None:
    """Prints a line on standard error. What would move a terminal's cursor is printed as an escape."""
    print(f"racebeam-evaluate: {printable(sentence)}", file=sys.stderr)


def _refuse_ignored(parser: argparse.ArgumentParser, options: argparse.Namespace) -> None:
    """Ends the program with a usage error if an option would have no effect."""
    kind = "--board" if options.board else "--paper" if options.paper else ""
    for name, is_given in (("--report", options.report is not None), ("--mix", options.mix)):
        if kind and is_given:
            parser.error(f"{name} cannot be given with {kind}")
    if options.viewer and not options.board:
        parser.error("--viewer can only be given with --board")


def _write_board(options: argparse.Namespace) -> int:
    site = build(options.results, Bootstrap(options.seed, options.repetitions), options.viewer or "")
    write(options.into, site.files)
    for sentence in site.broken:
        _complain(f"not shown: {sentence}")
    print(f"{site.submissions} submission{'s' * (site.submissions != 1)}: {options.into / 'index.html'}")
    return 3 if site.broken else 0


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="racebeam-evaluate",
        epilog=_EPILOG,
        description="Makes tables, tests and figures from results of racebeam experiment.",
    )
    parser.add_argument(
        "results",
        nargs="*",
        type=pathlib.Path,
        metavar="RESULTS",
        help="a folder with results.csv, or a file of Dopamine, DQN Zoo or rliable; several are evaluated together",
    )
    parser.add_argument("--paper", action="store_true", help="evaluate the scores that Bellemare et al. 2013 print")
    parser.add_argument(
        "--board", action="store_true", help="make a page of submissions: RESULTS are folders with agent.toml and logs"
    )
    parser.add_argument(
        "--viewer",
        type=_address,
        metavar="ADDRESS",
        help="address of a racebeam server's page, in which links of the board replay episodes",
    )
    parser.add_argument("--into", required=True, type=pathlib.Path, metavar="FOLDER", help="a new or an empty folder")
    parser.add_argument("--report", choices=_REPORTS, help=f"the kind of report (default: {_DEFAULT_REPORT})")
    parser.add_argument(
        "--mix",
        action="store_true",
        help="evaluate results of different settings together, and put them beside published ones of other settings",
    )
    parser.add_argument("--seed", type=_whole, default=1, help="seed of the bootstrap (default: %(default)s)")
    parser.add_argument(
        "--repetitions", type=_positive, default=2000, help="repetitions of the bootstrap (default: %(default)s)"
    )
    return parser


def _address(text: str) -> str:
    if not text.startswith(("http://", "https://")) or "#" in text:
        raise argparse.ArgumentTypeError(f"'{text}' is not accepted; expected http://... or https://... without '#'")
    return text


def _whole(text: str) -> int:
    if not text.isdecimal() or int(text) >= 2**32:
        raise argparse.ArgumentTypeError(f"'{text}' is not accepted; expected 0 to {2**32 - 1}")
    return int(text)


def _positive(text: str) -> int:
    if not text.isdecimal() or not 1 <= int(text) <= 1_000_000:
        raise argparse.ArgumentTypeError(f"'{text}' is not accepted; expected 1 to 1000000")
    return int(text)


def _report(options: argparse.Namespace) -> Report:
    bootstrap = Bootstrap(options.seed, options.repetitions)
    if options.paper:
        return evaluate_paper(bootstrap)
    return _REPORTS[options.report or _DEFAULT_REPORT](read_all(options.results, options.mix), bootstrap, options.mix)
