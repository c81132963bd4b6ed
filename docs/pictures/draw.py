#!/usr/bin/env python3
"""Draws the pictures of the documents, from the tables in this file and in docs/rooms.toml.

    draw.py            writes NAME.svg for each picture
    draw.py --check    writes nothing; status 1 if a file is not what would be written

A picture is boxes on a grid and arrows between them. A box is (column, row, columns that it spans, title, lines of
text, kind); an arrow is (from, to, label).
"""

import pathlib
import sys
from html import escape

import tomllib

FOLDER = pathlib.Path(__file__).resolve().parent
GRID = (204, 74, 60, 40)  # width and height of a box, gaps between columns and between rows; a picture may have its own
MARGIN, HEAD = 16, 30
COLOURS = {"code": ("#e8f0fb", "#3b6ea8"), "data": ("#fdf3dc", "#b0812b"), "outside": ("#f1f1f1", "#777777")}


def needed(uses):
    """Pairs of a folder and one that it uses, without those that follow from others. Each uses only those before it."""
    far = {}
    for key, row in uses.items():
        far[key] = set(row).union(*(far[entry] for entry in row))
    return [
        (key, entry)
        for key, row in uses.items()
        for entry in row
        if not any(entry in far[other] for other in row if other != entry)
    ]


ROOMS = tomllib.loads((FOLDER.parent / "rooms.toml").read_text())

LIBRARIES = {
    "title": "The libraries: an arrow leads from a library to one that it uses",
    "grid": (196, 48, 30, 28),
    "boxes": {
        "cli": (1, 0, 1, "cli", ["the program racebeam"], "code"),
        "agents": (0, 1, 1, "agents", ["learners, searches, scores"], "code"),
        "server": (2, 1, 1, "server", ["sockets, streams, limits"], "code"),
        "protocol": (2, 2, 1, "protocol", ["lines in, lines out"], "code"),
        "library": (0, 3, 1, "library", ["include/racebeam/, for C++"], "code"),
        "recording": (1, 3, 1, "recording", ["pictures, films, sound"], "code"),
        "environment": (1, 4, 1, "environment", ["acts, rewards, states"], "code"),
        "games": (1, 5, 1, "games", ["images, rules, modes"], "code"),
        "emulator": (1, 6, 1, "emulator", ["the machine"], "code"),
        "system": (1, 7, 1, "system", ["files, processors, words"], "code"),
    },
    "arrows": [(user, used, "") for user, used in needed(ROOMS["folders"])],
}

FRAME = {
    "title": "One frame, from a write to a pixel",
    "boxes": {
        "cpu": (0, 0, 1, "CPU", ["STA COLUBK, cycle 30", "interpreted or translated"], "code"),
        "log": (1, 0, 1, "WriteLog", ["cycle, register, value", "one word for each write"], "data"),
        "end": (2, 0, 1, "a collision is read,", ["or the step ends:", "the log is played"], "outside"),
        "lines": (2, 1, 1, "Tia: lines", ["the log, line by line, with", "the registers at its start"], "code"),
        "known": (1, 1, 1, "LineRecord", ["same registers,", "same writes as before?"], "data"),
        "recall": (0, 1, 1, "recall", ["copy the registers it leaves;", "pixels exist already"], "code"),
        "spans": (1, 2, 1, "Beam: spans", ["from one change", "to the next"], "code"),
        "masks": (2, 2, 1, "six masks", ["160 bits for each object"], "data"),
        "pixels": (1, 3, 1, "pixels, collisions", ["layers to colours: AVX-512,", "AVX2 or plain; 15 ANDs"], "code"),
        "picture": (0, 3, 1, "FrameBuffer", ["160 bytes a row,", "one palette index a pixel"], "data"),
    },
    "arrows": [
        ("cpu", "log", ""),
        ("log", "end", ""),
        ("end", "lines", ""),
        ("lines", "known", ""),
        ("known", "recall", "yes"),
        ("known", "spans", "no"),
        ("spans", "masks", ""),
        ("masks", "pixels", ""),
        ("pixels", "picture", ""),
        ("recall", "picture", ""),
    ],
}

THREADS = {
    "title": "Threads of the server (blue), and what they share (yellow)",
    "boxes": {
        "first": (0, 0, 1, "the first event loop", ["also accepts connections,", "and serves --http"], "code"),
        "loops": (1, 0, 1, "event loops", ["--threads of them;", "a connection stays on one"], "code"),
        "streams": (2, 0, 1, "stream threads", ["one for each session", "on stdio or pipes"], "code"),
        "session": (1, 1, 1, "session", ["each request on a fiber,", "in slices of 2 ms"], "outside"),
        "pool": (0, 2, 1, "thread pool", ["step the machines of open,", "each thread the same ones"], "code"),
        "log": (1, 2, 1, "log thread", ["if the log is a file;", "1,024 lines may wait"], "code"),
        "recorder": (2, 2, 1, "recorder: 2 threads", ["encode and write", "from short queues"], "code"),
        "code": (0, 3, 1, "translated code", ["one lock for each image;", "only grows"], "data"),
        "resets": (1, 3, 1, "finished resets", ["one lock; at most 128"], "data"),
        "meters": (2, 3, 1, "meters", ["one for each loop: no lock;", "summed for --http"], "data"),
    },
    "arrows": [
        ("first", "loops", "accepts"),
        ("loops", "session", ""),
        ("streams", "session", ""),
        ("session", "pool", "step"),
        ("session", "log", "lines"),
        ("session", "recorder", "frames"),
    ],
}

STATE = {
    "title": "The life of a saved state",
    "boxes": {
        "machine": (0, 0, 1, "running machine", ["State: at most 640 bytes,", "two pictures, rule, sound"], "code"),
        "saved": (1, 0, 1, "Saved, in memory", ["values are copies;", "pictures are shared"], "data"),
        "bytes": (2, 0, 1, "bytes", ["RBSTATE, version, sizes,", "CRC-32, MD5, values"], "data"),
        "drawn": (0, 1, 1, "next frame drawn", ["takes another buffer:", "the shared one stays"], "code"),
        "restore": (1, 1, 1, "restore", ["copies the values back,", "shares the pictures"], "code"),
        "check": (2, 1, 1, "check", ["checksum, version, image,", "then every field's range"], "code"),
        "again": (1, 2, 1, "the same future", ["on this machine, another,", "or in another process"], "code"),
        "refused": (2, 2, 1, "bad-state", ["names the field; the", "session goes on unchanged"], "outside"),
    },
    "arrows": [
        ("machine", "saved", "save"),
        ("saved", "bytes", "export"),
        ("machine", "drawn", ""),
        ("saved", "restore", ""),
        ("bytes", "check", "import"),
        ("check", "restore", "valid"),
        ("check", "refused", "not valid"),
        ("restore", "again", ""),
    ],
}

PICTURES = {"libraries": LIBRARIES, "frame": FRAME, "threads": THREADS, "state": STATE}


def places(picture):
    """{name: (left, top, width, height)} of all boxes."""
    width, height, gap_x, gap_y = picture.get("grid", GRID)
    return {
        name: (
            MARGIN + column * (width + gap_x),
            MARGIN + HEAD + row * (height + gap_y),
            span * width + (span - 1) * gap_x,
            height,
        )
        for name, (column, row, span, *_) in picture["boxes"].items()
    }


def draw_box(box, where):
    left, top, width, height = where
    *_, title, lines, kind = box
    fill, stroke = COLOURS[kind]
    middle, first = left + width / 2, top + height / 2 - 8 * len(lines) + 4
    parts = [
        f'<rect x="{left}" y="{top}" width="{width}" height="{height}" rx="6" fill="{fill}" stroke="{stroke}"/>',
        f'<text x="{middle}" y="{first}" font-weight="bold">{escape(title)}</text>',
    ]
    parts += [
        f'<text x="{middle}" y="{first + 17 * (at + 1)}" font-size="12">{escape(line)}</text>'
        for at, line in enumerate(lines)
    ]
    return "\n".join(parts)


def ends(one, other):
    """Where an arrow leaves one box and reaches another: on the sides that face each other."""
    (left, top, width, height), (to_left, to_top, to_width, to_height) = one, other
    if top == to_top:
        right = to_left > left
        return (left + width * right, top + height / 2), (to_left + to_width * (not right), to_top + to_height / 2)
    down = to_top > top
    return (left + width / 2, top + height * down), (to_left + to_width / 2, to_top + to_height * (not down))


def draw_arrow(one, other, label):
    (x1, y1), (x2, y2) = ends(one, other)
    parts = [f'<line x1="{x1}" y1="{y1}" x2="{x2}" y2="{y2}" stroke="#444" stroke-width="1.5" marker-end="url(#tip)"/>']
    if label:
        x, y = (x1 + x2) / 2, (y1 + y2) / 2
        x, y = (x, y - 6) if y1 == y2 else (x + 8, y + 4)
        anchor = "middle" if y1 == y2 else "start"
        parts.append(f'<text x="{x}" y="{y}" font-size="11" text-anchor="{anchor}">{escape(label)}</text>')
    return "\n".join(parts)


def draw(picture):
    where = places(picture)
    width = max(left + width for left, _, width, _ in where.values()) + MARGIN
    height = max(top + height for _, top, _, height in where.values()) + MARGIN
    shapes = [draw_box(box, where[name]) for name, box in picture["boxes"].items()]
    shapes += [draw_arrow(where[start], where[end], label) for start, end, label in picture["arrows"]]
    title = escape(picture["title"])
    return "\n".join(
        [
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}"',
            '     font-family="sans-serif" font-size="14" text-anchor="middle" role="img">',
            f"<title>{title}</title>",
            (
                '<defs><marker id="tip" viewBox="0 0 8 8" refX="8" refY="4" markerWidth="8" markerHeight="8" '
                'orient="auto">'
            ),
            '<path d="M0 0 L8 4 L0 8 z" fill="#444"/></marker></defs>',
            f'<rect width="{width}" height="{height}" fill="white"/>',
            f'<text x="{width / 2}" y="26" font-size="13">{title}</text>',
            *shapes,
            "</svg>",
            "",
        ]
    )


def main():
    stale = []
    for name, picture in PICTURES.items():
        path = FOLDER / f"{name}.svg"
        text = draw(picture)
        if "--check" not in sys.argv[1:]:
            path.write_text(text)
        elif not path.exists() or path.read_text() != text:
            stale.append(path.name)
    if stale:
        sys.exit(f"not what draw.py draws: {', '.join(stale)}; run docs/pictures/draw.py")


if __name__ == "__main__":
    main()
