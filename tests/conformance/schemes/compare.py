"""Compares each cartridge scheme with the reference on generated images, by random accesses (images.py).

    compare.py PROBE [SCHEME...] [--seed N] [--frames N]

Needs ale-py, from .venv if this Python lacks it. Status 0: all are equal; 1: one differs; 77: ale-py is missing.
"""

import argparse
import glob
import os
import random
import subprocess
import sys
import tempfile
import zlib

import images

GAME = "pitfall2"  # the reference takes an unknown image by its name; this game's rule ends at one exact score only
SOURCE = os.path.abspath(os.path.join(os.path.dirname(__file__), *[os.pardir] * 3))
SKIPPED = 77

STA, LDA, INC, CMP_X, BIT, JSR, NOP, STX = 0x8D, 0xAD, 0xEE, 0xDD, 0x2C, 0x20, 0x0C, 0x8E
WSYNC = 0x42


def reference():
    """ale_py, or None."""
    for folder in glob.glob(os.path.join(SOURCE, ".venv", "lib", "python*", "site-packages")):
        sys.path.append(folder)
    try:
        import ale_py
    except ImportError:
        return None
    ale_py.ALEInterface.setLoggerMode(ale_py.LoggerMode.Error)
    return ale_py


class Reference:
    def __init__(self, ale_py, path):
        self.ale = ale_py.ALEInterface()
        self.ale.setInt("random_seed", 1)
        self.ale.setFloat("repeat_action_probability", 0.0)
        self.ale.loadROM(path)
        self.first = self.answer()

    def answer(self):
        return self.ale.getRAM().tobytes().hex() + f" {zlib.crc32(self.ale.getScreen().tobytes()):08x}"

    def frame(self, pokes):
        for index, value in pokes:
            self.ale.setRAM(index, value)
        self.ale.act(0)
        return self.answer()

    def reset(self):
        self.ale.reset_game()
        return self.answer()


class Ours:
    def __init__(self, probe, path):
        self.process = subprocess.Popen([probe, path, GAME], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        self.first = self.answer()

    def answer(self):
        return self.process.stdout.readline().rstrip()

    def ask(self, line):
        self.process.stdin.write(line + "\n")
        self.process.stdin.flush()
        return self.answer()

    def frame(self, pokes):
        return self.ask(" ".join(f"{index} {value}" for index, value in pokes))

    def reset(self):
        return self.ask("reset")

    def close(self):
        self.process.stdin.close()
        self.process.wait()


def random_address(rng, scheme):
    if rng.random() < 0.25:
        return 0x1000 | rng.randrange(0x1000) | rng.choice([0, 0xE000])
    first, size = rng.choice(images.LIVELY.get(scheme, images.ATARI))
    return first + rng.randrange(size)


def random_slot(rng, scheme):
    """Value, opcode, address."""
    value = rng.choice([rng.randrange(256), rng.randrange(16), 0x80 | rng.randrange(128)])
    opcode, address = rng.choice([STA, STA, STA, LDA, LDA, LDA, INC, BIT]), random_address(rng, scheme)
    if scheme == "AR" and address & 0x0800 and opcode == LDA:
        opcode = BIT  # its bytes may be those of the BIOS, which differs from the reference's
    return value, opcode, address


def subroutine(rng, scheme):
    """Calls the code in the pages of the hot spots."""
    if scheme == "MC":  # only its locked window certainly has it
        return [(0, BIT, 0x1FFC), (0, JSR, 0xFC00 | images.SNIPPET)]
    return [(rng.randrange(256), JSR, 0xF000 | images.CHUNK * rng.randrange(4) | images.SNIPPET)]


def ram_code(rng, scheme):
    """Writes EOR #value; RTS to cartridge RAM, and calls it."""
    select, first, read_port, size = rng.choice(images.RAM_CODE[scheme])
    at = rng.randrange(size - 2)
    code = [0x49, rng.randrange(256), 0x60]
    stores = [(byte, STA, first + at + number) for number, byte in enumerate(code)]
    return [(rng.randrange(32), STA, select), *stores, (rng.randrange(256), JSR, 0xE000 | read_port + at)]


def random_slots(rng, scheme):
    slots = []
    while len(slots) < images.SLOTS:
        kind = rng.random()
        if kind < 0.05:
            slots += [(0, STA, WSYNC)]
        elif kind < 0.15 and scheme != "AR":
            slots += subroutine(rng, scheme)
        elif kind < 0.25 and scheme in images.RAM_CODE:
            slots += ram_code(rng, scheme)
        else:
            slots += [random_slot(rng, scheme)]
    return slots[: images.SLOTS]


def pokes_of(slots):
    for number, (value, opcode, address) in enumerate(slots):
        at = images.FIRST_SLOT + images.SLOT_SIZE * number
        yield from ((at + 1, value), (at + 2, opcode), (at + 3, address & 0xFF), (at + 4, address >> 8))


def describe(slots):
    return ", ".join(f"A={value:02X} {opcode:02X} {address:04X}" for value, opcode, address in slots)


def counter_in(answer):
    return bytes.fromhex(answer[:256])[images.COUNTER]


def differing(a, b):
    a, b = (bytes.fromhex(answer[:256]) for answer in (a, b))
    places = [f"RAM[{i:02X}] {x:02X} {y:02X}" for i, (x, y) in enumerate(zip(a, b)) if x != y]
    return ", ".join(places) or "the screen"


def align(scheme, *machines):
    """Removes what cannot be compared. MC: its registers, which are undefined in the reference at power-on.
    AR: the duration of the BIOS in frames."""
    if scheme == "MC":
        pokes = list(pokes_of([(0x80 + number, STA, 0x3C + number) for number in range(4)]))
    else:
        pokes = [(images.COUNTER, 0), *pokes_of([(0, BIT, 0x1004), (0, BIT, 0x1FF8)])]
    return [machine.frame(pokes) for machine in machines]


def compare(ale_py, probe, scheme, seed, frames):
    """The first difference as a sentence, or nothing. For AR, only RAM is compared: the reference's BIOS
    leaves a picture."""
    rng = random.Random(f"{scheme} {seed} accesses")
    limit = 256 if scheme == "AR" else None
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, GAME + ".bin")
        with open(path, "wb") as file:
            file.write(images.image(scheme, seed))
        theirs, ours = Reference(ale_py, path), Ours(probe, path)
        try:
            a, b = align(scheme, theirs, ours) if scheme in ("AR", "MC") else (theirs.first, ours.first)
            if a[:limit] != b[:limit]:
                return f"at the start:\n    {differing(a, b)}\n    reference {a}\n    racebeam  {b}"
            stuck, counter = False, -1
            for frame in range(frames):
                if stuck or scheme != "AR" and rng.random() < 0.002:
                    what, a, b = "reset", theirs.reset(), ours.reset()
                else:
                    slots = random_slots(rng, scheme)
                    pokes = list(pokes_of(slots))
                    what, a, b = describe(slots), theirs.frame(pokes), ours.frame(pokes)
                if a[:limit] != b[:limit]:
                    return f"frame {frame}: {what}\n    {differing(a, b)}\n    reference {a}\n    racebeam  {b}"
                stuck = counter == counter_in(a)  # a subroutine did not return
                counter = counter_in(a)
        finally:
            ours.close()
    return None


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("probe")
    parser.add_argument("--seed", default="1")
    parser.add_argument("--frames", type=int, default=2000)
    parser.add_argument("schemes", nargs="*", default=list(images.MAKERS))
    options = parser.parse_args()
    ale_py = reference()
    if ale_py is None:
        print("skipped: ale-py is not there (scripts/reference installs it)")
        return SKIPPED
    differences = 0
    for scheme in options.schemes or images.MAKERS:
        difference = compare(ale_py, options.probe, scheme, options.seed, options.frames)
        differences += difference is not None
        print(f"{scheme:6} {difference or f'{options.frames} frames, no difference'}", flush=True)
    return 1 if differences else 0


if __name__ == "__main__":
    sys.exit(main())
