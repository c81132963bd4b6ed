"""Draws ratios as SVG: a bar for each game, the shortest first."""
import html
import math

ROW, GAP, LEFT, TOP, WIDTH, RIGHT = 14, 3, 150, 60, 640, 60  # pixels
BAR, LINE, TEXT = "#3b6ea5", "#bbbbbb", "#333333"


def text(x, y, words, size=11, anchor="start", weight="normal"):
    return (f'<text x="{x:.1f}" y="{y:.1f}" font-size="{size}" text-anchor="{anchor}" font-weight="{weight}" '
            f'fill="{TEXT}">{html.escape(words)}</text>')


def draw(ratios, heading):
    """Returns the SVG as text. ratios: {game: ratio to the reference}."""
    rows = sorted(ratios.items(), key=lambda row: row[1])
    mean = math.exp(sum(map(math.log, ratios.values())) / len(ratios))
    end = max(10, math.ceil(rows[-1][1]))
    scale = WIDTH / end
    height = TOP + len(rows) * ROW + 10
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{LEFT + WIDTH + RIGHT}" height="{height}" '
             f'font-family="sans-serif">', '<rect width="100%" height="100%" fill="white"/>',
             text(10, 20, f"{heading}: frames/s of racebeam, as multiples of ALE's", 14, weight="bold"),
             text(10, 38, f"{len(rows)} games, geomean {mean:.2f}, worst {rows[0][1]:.2f} ({rows[0][0]})")]
    for multiple in range(1, end + 1):
        x = LEFT + multiple * scale
        parts += [f'<line x1="{x:.1f}" y1="{TOP - 4}" x2="{x:.1f}" y2="{height - 8}" stroke="{LINE}"/>',
                  text(x, TOP - 7, f"{multiple}x", 10, "middle")]
    for number, (game, ratio) in enumerate(rows):
        y = TOP + number * ROW
        parts += [text(LEFT - 6, y + ROW - GAP, game, anchor="end"),
                  f'<rect x="{LEFT}" y="{y + 1}" width="{ratio * scale:.1f}" height="{ROW - GAP}" fill="{BAR}"/>',
                  text(LEFT + ratio * scale + 4, y + ROW - GAP, f"{ratio:.2f}", 10)]
    return "\n".join([*parts, "</svg>"]) + "\n"
