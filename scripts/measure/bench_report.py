"""Writes the results of scripts/bench core: a summary in a document, each game's figures in another, and two
pictures."""

import os
import pathlib
import platform
import re
import statistics
import subprocess

import bench_picture
import cartridges
import page_part
import processor
from bench_settings import SETTINGS

PAGE = cartridges.ROOT / "docs/performance.md"
FIGURES = cartridges.ROOT / "docs/performance/figures.md"
PICTURE = cartridges.ROOT / "docs/performance/core.svg"
SUMMARY = cartridges.ROOT / "docs/performance/summary.svg"
SCRIPT = "scripts/bench core"  # as the document names it
HEADINGS = {name: setting.heading for name, setting in SETTINGS.items()}


def machine():
    system = platform.freedesktop_os_release().get("PRETTY_NAME", platform.system())
    return {"processor": processor.name(), "processors": os.cpu_count(), "system": system}


def output(*command):
    done = subprocess.run(command, capture_output=True, text=True, cwd=cartridges.ROOT)
    return done.stdout.strip() if done.returncode == 0 else "unknown"


def compiler(binary):
    """The compiler, as the CMake cache beside the program names it."""
    cache = pathlib.Path(binary).parent / "CMakeCache.txt"
    found = re.search(r"^CMAKE_CXX_COMPILER:\w+=(.*)$", cache.read_text(), re.M) if cache.exists() else None
    return output(found[1], "--version").splitlines()[0] if found else "unknown"


def versions(binary):
    import ale_py

    return {
        "racebeam": output(binary, "--version").removeprefix("racebeam "),
        "commit": output("git", "describe", "--always", "--dirty"),
        "compiler": compiler(binary),
        "ale_py": ale_py.__version__,
        "python": platform.python_version(),
    }


def settings_in(results):
    first = next(iter(results["games"].values()))
    return [name for name in HEADINGS if name in first]


def summary(results):
    """Returns {setting: (geomean, worst ratio, its game)}; resets and saved states count as settings."""
    columns = {
        HEADINGS[name]: {game: found[name]["ratio"] for game, found in results["games"].items()}
        for name in settings_in(results)
    }
    if all("states" in found for found in results["games"].values()):
        for key, heading in (("reset_ratio", "Reset"), ("save_restore_ratio", "Save and restore, with pictures")):
            columns[heading] = {game: found["states"][key] for game, found in results["games"].items()}
    return {
        heading: (statistics.geometric_mean(ratios.values()), *min((ratio, game) for game, ratio in ratios.items()))
        for heading, ratios in columns.items()
    }


def table(headings, rows):
    numbers = "---:|" * (len(headings) - 1)
    return "\n".join(
        ["| " + " | ".join(headings) + " |", "|---|" + numbers, *("| " + " | ".join(row) + " |" for row in rows)]
    )


def summary_table(results):
    rows = [[heading, f"{mean:.2f}", f"{worst:.2f}", game] for heading, (mean, worst, game) in summary(results).items()]
    return table(["what is measured", "geomean", "worst", "of"], rows)


def speed_table(results):
    names = settings_in(results)
    headings = ["game"]
    for name in names:
        headings += [f"{name}: ALE, frames/s", "racebeam", "ratio"]
    rows = []
    for game, found in results["games"].items():
        row = [game]
        for figures in (found[name] for name in names):
            row += [
                f"{figures['ale_frames_per_second']:,.0f}",
                f"{figures['racebeam_frames_per_second']:,.0f}",
                f"{figures['ratio']:.2f}",
            ]
        rows.append(row)
    return table(headings, rows)


def states_table(results):
    rows = [
        [
            game,
            f"{s['ale_reset_ms']:.2f}",
            f"{s['racebeam_reset_ms']:.3f}",
            f"{s['ale_save_restore_ns']:,.0f}",
            f"{s['racebeam_save_restore_ns']:,.0f}",
            f"{s['machine_save_restore_ns']:,.0f}",
        ]
        for game, s in ((game, found["states"]) for game, found in results["games"].items())
    ]
    return table(
        [
            "game",
            "reset: ALE, ms",
            "racebeam, ms",
            "save + restore: ALE, ns",
            "racebeam, with pictures, ns",
            "the machine alone, ns",
        ],
        rows,
    )


def circumstances(results):
    at, of = results["machine"], results["versions"]
    facts = [
        ("command", f"`{results['command']}`"),
        ("date, duration", f"{results['date']}, {results['seconds']} seconds"),
        ("processor", f"{at['processor']}, {at['processors']} processors"),
        ("system", at["system"]),
        ("racebeam", f"{of['racebeam']} ({of['commit']}), {of['compiler']}"),
        ("reference", f"ale-py {of['ale_py']}, Python {of['python']}"),
        (
            "games",
            f"{len(results['games'])}, {results['frames']:,} frames of each in each setting, in chunks of "
            f"{results['chunk_frames']}; every frame was checked",
        ),
    ]
    return "\n".join(["| run | value |", "|---|---|", *(f"| {name} | {value} |" for name, value in facts)])


def page(results):
    return "\n\n".join([circumstances(results), summary_table(results)])


def figures(results):
    """The document with every game's figures."""
    parts = [
        "# Figures of all games",
        "Written by `scripts/bench core --write`, not by hand. "
        "[performance.md](../performance.md) says how\nthey are measured.",
        circumstances(results),
    ]
    if settings_in(results):
        parts += ["## Frames", speed_table(results)]
    if all("states" in found for found in results["games"].values()):
        parts += ["## Resets and states", states_table(results)]
    return "\n\n".join(parts) + "\n"


def write(results):
    """Writes summary, figures and pictures. Raises OSError, and writes nothing, if the document has no place for it."""
    names = settings_in(results)
    heading = HEADINGS[names[0]] if names else ""
    picture = f"![{heading}: ratio to ALE, by game]({PICTURE.relative_to(PAGE.parent)})\n\n" if names else ""
    page_part.replace(PAGE, SCRIPT, f"{picture}{page(results)}\n")
    FIGURES.parent.mkdir(exist_ok=True)
    FIGURES.write_text(figures(results))
    if names:
        ratios = {game: found[names[0]]["ratio"] for game, found in results["games"].items()}
        PICTURE.write_text(bench_picture.draw(ratios, heading))
        means = {HEADINGS[name]: round(summary(results)[HEADINGS[name]][0], 2) for name in names}  # as in the table
        SUMMARY.write_text(bench_picture.draw_summary(means, len(ratios)))
