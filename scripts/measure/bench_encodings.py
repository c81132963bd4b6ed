"""Measures the cost of each encoding of the line protocol for a client: bytes of a field, and the time to decode it.

The games are played randomly, with four frames an act. The client in Python
(clients/python/single_file/client.py) and one in C++ (tests/protocol/bench/decode_bench.cpp) decode the same texts, and
must get the same bytes. Times are processor time, the least of seven rounds. Prints the table of docs/performance.md.
"""

import argparse
import pathlib
import random
import subprocess
import sys
import time
import zlib

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "clients/python/single_file"))
import client as racebeam  # noqa: E402
from bench_report import machine  # noqa: E402
from cartridges import image_or_own, name_of  # noqa: E402

BUILD = ROOT / "build/release"
ENCODINGS = ("hex", "rle", "delta", "base64", "zlib")
FIELDS = {"screen": 33600, "rgb": 100800, "grey84x84x1": 84 * 84}
ROUNDS = 7


def texts_of(rom, field, encoding, acts):
    """The texts of this field in replies to random acts."""
    options = ("--log-level", "warning") + (() if rom.startswith("builtin:") else ("--rom", rom))
    with racebeam.Session.start(str(BUILD / "racebeam"), *options) as session:
        session.load(name_of(rom), seed=1, sticky=0, frame_skip=4)
        actions = sorted(session.actions())
        session.observe("terminated", "truncated", f"{field}:{encoding}")
        draw = random.Random(7)
        texts = []
        for _ in range(acts):
            reply = session.ask("act", draw.choice(actions))[0]
            texts.append(reply[field])
            if "1" in (reply["terminated"], reply["truncated"]):
                texts.append(session.ask("reset")[0][field])
        return texts


def in_python(encoding, size, texts):
    """Returns microseconds per text, and the Adler-32 of the last decoded bytes."""
    best = None
    for _ in range(ROUNDS):
        array = bytearray(size)
        start = time.process_time()
        for text in texts:
            if encoding == "delta":
                racebeam.apply_delta(array, text)
            else:
                array = racebeam.DECODERS[encoding](text)
        spent = (time.process_time() - start) / len(texts) * 1e6
        best = spent if best is None else min(best, spent)
    return best, zlib.adler32(array)


def in_cpp(encoding, size, texts):
    done = subprocess.run(
        [BUILD / "tests/protocol/decode_bench", encoding, str(size)],
        input="\n".join(texts) + "\n",
        capture_output=True,
        text=True,
        check=True,
    )
    microseconds, digest = done.stdout.split()
    return float(microseconds), int(digest)


def row(roms, field, encoding, acts):
    size = FIELDS[field]
    characters, python, cpp = [], [], []
    for rom in roms:
        texts = texts_of(rom, field, encoding, acts)
        characters.append(sum(map(len, texts)) / len(texts))
        times, digests = zip(in_python(encoding, size, texts), in_cpp(encoding, size, texts))
        if digests[0] != digests[1]:
            sys.exit(f"bench: the clients decode {field}:{encoding} of {name_of(rom)} differently")
        python.append(times[0])
        cpp.append(times[1])
    mean = [sum(values) / len(values) for values in (characters, python, cpp)]
    return f"| `{field}:{encoding}` | {mean[0]:,.0f} | {mean[1]:,.0f} | {mean[2]:,.1f} |"


def main():
    parser = argparse.ArgumentParser(
        prog="scripts/bench encodings", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "--games",
        nargs="+",
        default=["pong", "seaquest", "ms_pacman"],
        metavar="GAME",
        help="games whose mean is printed (default: pong seaquest ms_pacman)",
    )
    parser.add_argument("--acts", type=int, default=300, help="acts of each game (default 300)")
    arguments = parser.parse_args()
    subprocess.run([ROOT / "scripts/build", "decode_bench"], check=True, stdout=sys.stderr)
    roms = list(dict.fromkeys(image_or_own(game) for game in arguments.games))
    found = machine()
    print(f"{found['processor']}, Python {sys.version.split()[0]}; means of {', '.join(map(name_of, roms))}\n")
    print("| field and encoding | bytes a reply | decoding in Python, us | in C++, us |\n|---|---:|---:|---:|")
    for field in FIELDS:
        for encoding in ENCODINGS:
            print(row(roms, field, encoding, arguments.acts), flush=True)


if __name__ == "__main__":
    main()
