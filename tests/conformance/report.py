"""Writes docs/conformance.md from the results."""

import collections
import datetime
import textwrap

from compare import IDENTICAL
from images import HOST, WITHOUT_RULE
from not_comparable import NOT_COMPARABLE
from ours import FORMS
from run import COLORS_EVERY, WRITE, Run

HEAD = """# Conformance

`scripts/conformance` writes this document; it is not edited by hand. It answers whether racebeam
and the reference do the same. The reference is ALE, through ale-py.

Both play the same random actions with the same settings. After every act and every reset, these
values must be equal:

- the screen's palette indices, RAM, and the 512 samples of sound;
- reward, game over, truncated, and lives;
- frame number and episode frame number.

The pictures in RGB and in grey follow from the indices. They are compared after every act with
colour averaging, else in every {every}th line. At loading, modes, difficulties, and the legal and
minimal actions are compared. Actions are drawn from all 18 and held for four acts on average. After
the end of an episode, both sides are reset.

The default settings are the game's own mode and difficulty, frame skip 1, no sticky actions, no
averaging. The other settings are all of {{default, each other mode, each other difficulty}} x frame
skip {{1, 4}} x sticky {{0, 0.25}} x colour averaging {{off, on}}. Some of these runs, by chance, do
more: they write bytes of RAM (before {write:.0%} of the acts), limit an episode's frames, truncate
at the loss of a life, or turn paddles by random strengths.

    {command}

| run | value |
|---|---|
| date | {date} |
| racebeam | {version} |
| reference | ale-py {reference} |
| seeds | {seeds} |
| forms of racebeam's machine | {forms} |
"""


def wrapped(paragraph):
    return textwrap.fill(paragraph, 100, break_long_words=False, break_on_hyphens=False)


def is_default(run):
    return run.setting == (None, None, 1, 0, 0) and not (run.writes or run.limit or run.lifeloss or run.strengths)


def row(game, results):
    runs = [Run.parse(result["run"]) for result in results]
    default = [result["frames"] for run, result in zip(runs, results) if is_default(run)]
    other = [result["frames"] for run, result in zip(runs, results) if not is_default(run)]
    bad = sum(result["verdict"] != IDENTICAL for result in results)
    verdict = "identical" if not bad else f"**{bad} of {len(results)} runs are not identical**"
    return (
        f"| {game} | {' + '.join(f'{frames:,}' for frames in default) or '-'} | "
        f"{len({run.setting for run in runs} - {(None, None, 1, 0, 0)})} | {sum(other):,} | {verdict} |"
    )


def totals(results):
    runs = [Run.parse(result["run"]) for result in results]

    def count(key):
        return sum(bool(getattr(run, key)) for run in runs)

    bad = [result for result in results if result["verdict"] != IDENTICAL]
    games = {run.game for run in runs}
    good_games = games - {Run.parse(result["run"]).game for result in bad}
    frames = sum(result["frames"] for result in results)
    return wrapped(
        f"{len(good_games)} of {len(games)} games are identical in all their runs; "
        f"{len(results) - len(bad):,} of {len(results):,} runs, {frames:,} frames. Among them "
        f"{count('writes'):,} runs with writes to RAM, {count('limit'):,} with a limit of frames, "
        f"{count('lifeloss'):,} truncated at the loss of a life, "
        f"{count('strengths'):,} with random strengths."
    )


def gap_table(gaps):
    counts = collections.Counter(gap for _, gap in gaps)
    lines = [
        f"| {', '.join(gap.games)} | {gap.key} | {counts[gap]} run{'s' * (counts[gap] != 1)} | {gap.reason} |"
        for gap in NOT_COMPARABLE
    ]
    return "\n".join(["| game | what | left out of | why |", "|---|---|---|---|", *lines])


def mismatches(results):
    bad = [result for result in results if result["verdict"] != IDENTICAL]
    lines = [f"- `{result['run']}`: {result['verdict']}: {result['report'].splitlines()[0]}" for result in bad[:50]]
    if len(bad) > len(lines):
        lines.append(f"- and {len(bad) - len(lines)} more")
    return "\n".join(["## Not identical", "", *lines, ""]) if bad else ""


def markdown(results, identity, command, gaps):
    by_game = collections.defaultdict(list)
    for result in results:
        by_game[Run.parse(result["run"]).game].append(result)
    head = HEAD.format(
        every=COLORS_EVERY,
        write=WRITE,
        command=command,
        date=datetime.date.today().isoformat(),
        version=identity["version"],
        reference=identity["reference"],
        seeds=", ".join(map(str, identity["seeds"])),
        forms=", ".join(["as this processor gets it", *(FORMS if identity["forms"] else ())]),
    )
    hosted = ", ".join(game for game in WITHOUT_RULE if game in by_game)
    parts = [
        head,
        "## Verdict",
        "",
        totals(results),
        "",
        mismatches(results),
        "## Not comparable",
        "",
        gap_table(gaps),
        "",
        "## Games",
        "",
        "| game | frames, default settings | other settings | frames in them | verdict |",
        "|---|---|---|---|---|",
        *(row(game, by_game[game]) for game in sorted(by_game)),
    ]
    if hosted:
        parts += [
            "",
            wrapped(
                f"The reference has no rule for {hosted}. Their machines are compared with the "
                f"actions, rule and difficulties of {HOST} on both sides."
            ),
        ]
    return "\n".join(parts).replace("\n\n\n", "\n\n") + "\n"
