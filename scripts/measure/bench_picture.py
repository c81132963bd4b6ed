"""Draws figures as SVG: ratios of all games, a bar for each, the shortest first; a summary, a bar for each setting; and
the course of figures over time."""

import html
import math
import statistics

ROW, GAP, LEFT, TOP, WIDTH, RIGHT = 14, 3, 150, 60, 640, 60  # pixels
BAR, LINE, TEXT = "#3b6ea5", "#bbbbbb", "#333333"


def text(x, y, words, size=11, anchor="start", weight="normal"):
    return (
        f'<text x="{x:.1f}" y="{y:.1f}" font-size="{size}" text-anchor="{anchor}" font-weight="{weight}" '
        f'fill="{TEXT}">{html.escape(words)}</text>'
    )


def draw(ratios, heading):
    """Returns the SVG as text. ratios: {game: ratio to the reference}."""
    rows = sorted(ratios.items(), key=lambda row: row[1])
    mean = statistics.geometric_mean(ratios.values())
    end = max(10, math.ceil(rows[-1][1]))
    scale = WIDTH / end
    height = TOP + len(rows) * ROW + 10
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{LEFT + WIDTH + RIGHT}" height="{height}" '
        f'font-family="sans-serif">',
        '<rect width="100%" height="100%" fill="white"/>',
        text(10, 20, f"{heading}: frames/s of racebeam, as multiples of ALE's", 14, weight="bold"),
        text(10, 38, f"{len(rows)} games, geomean {mean:.2f}, worst {rows[0][1]:.2f} ({rows[0][0]})"),
    ]
    for multiple in range(1, end + 1):
        x = LEFT + multiple * scale
        parts += [
            f'<line x1="{x:.1f}" y1="{TOP - 4}" x2="{x:.1f}" y2="{height - 8}" stroke="{LINE}"/>',
            text(x, TOP - 7, f"{multiple}x", 10, "middle"),
        ]
    for number, (game, ratio) in enumerate(rows):
        y = TOP + number * ROW
        parts += [
            text(LEFT - 6, y + ROW - GAP, game, anchor="end"),
            f'<rect x="{LEFT}" y="{y + 1}" width="{ratio * scale:.1f}" height="{ROW - GAP}" fill="{BAR}"/>',
            text(LEFT + ratio * scale + 4, y + ROW - GAP, f"{ratio:.2f}", 10),
        ]
    return "\n".join([*parts, "</svg>"]) + "\n"


def draw_summary(means, games):
    """Returns a picture of the geometric means as SVG text. means: {setting's heading: ratio to the reference}."""
    row, left, width = 30, 280, 470
    scale = width / max(means.values())
    height = 44 + (len(means) + 1) * row
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{left + width + RIGHT}" height="{height}" '
        f'font-family="sans-serif">',
        '<rect width="100%" height="100%" fill="white"/>',
        text(10, 24, f"Frames a second on one core, as multiples of ALE's: means of {games} games", 14, weight="bold"),
    ]
    bars = [
        ("ALE 0.12, in any setting", 1.0, LINE),
        *((f"racebeam: {heading}", mean, BAR) for heading, mean in means.items()),
    ]
    for number, (heading, ratio, colour) in enumerate(bars):
        y = 40 + number * row
        parts += [
            text(left - 8, y + 16, heading, anchor="end"),
            f'<rect x="{left}" y="{y + 2}" width="{ratio * scale:.1f}" height="{row - 10}" fill="{colour}"/>',
            text(left + ratio * scale + 6, y + 17, f"{ratio:.1f}", 12, weight="bold"),
        ]
    return "\n".join([*parts, "</svg>"]) + "\n"


def draw_course(hours, rows, headings):
    """Returns the course of figures over time as SVG text, a panel for each of them.

    hours: the time of each row. rows: {column: value}, one for each time. headings: {column: what it is}."""
    panel, left, width = 110, 60, 640
    height = 20 + len(headings) * panel
    end = max(hours)
    parts = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{left + width + RIGHT}" height="{height}" '
        f'font-family="sans-serif">',
        '<rect width="100%" height="100%" fill="white"/>',
    ]
    for number, (column, heading) in enumerate(headings.items()):
        values = [row[column] for row in rows]
        top, bottom, most = number * panel + 28, (number + 1) * panel, max(*values, 1e-9)
        points = " ".join(
            f"{left + width * hour / end:.1f},{bottom - (bottom - top) * value / most:.1f}"
            for hour, value in zip(hours, values, strict=True)
        )
        parts += [
            text(left, top - 8, f"{heading}: at most {max(values):.4g}", weight="bold"),
            *(f'<line x1="{left}" y1="{y}" x2="{left + width}" y2="{y}" stroke="{LINE}"/>' for y in (top, bottom)),
            text(left - 6, top + 4, f"{most:.4g}", 10, "end"),
            text(left - 6, bottom + 4, "0", 10, "end"),
            f'<polyline points="{points}" fill="none" stroke="{BAR}"/>',
        ]
    parts += [text(left, height - 5, "0", 10, "middle"), text(left + width, height - 5, f"{end:.2f} h", 10, "middle")]
    return "\n".join([*parts, "</svg>"]) + "\n"
