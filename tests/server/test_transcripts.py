"""Recorded sessions of the classic server are reproduced byte for byte, for any division of the input."""

import hashlib
import os
import re

import pytest
from harness import SOURCE, TRANSPORTS, Session, rom

FOLDER = os.path.join(SOURCE, "docs", "spec", "transcripts")
TETRIS = rom("tetris")
pytestmark = pytest.mark.needs_roms("tetris")
FIXED = ("--seed", "123", "--sticky", "0")
TRANSCRIPTS = {
    "tetris-rle-ram-rl.txt": (),
    "tetris-full-screen.txt": ("--full-screen",),
    "tetris-rl-only-limits.txt": ("--max-episode-frames", "6", "--max-frames", "12"),
}
RECORDED = {  # MD5 of each file as it was recorded (docs/spec/classic-protocol.md, 12)
    "tetris-rle-ram-rl.txt": "8d22f282c11cf8976cac099035f5799f",
    "tetris-full-screen.txt": "45ee2a4f150d258c2f63d7ff07c212d5",
    "tetris-rl-only-limits.txt": "50d4cd3ef59db24e15a9210b600dc735",
}


def expanded(line):
    """A line of a transcript. The screen of a `<~ ` line is run-length text."""
    if not line.startswith(b"<~ "):
        return line
    return b"< " + re.sub(rb"(..)(..)", lambda run: run[1] * int(run[2], 16), line[3:-2]) + b":\n"


def recorded(name):
    """The lines of a transcript, as they were recorded."""
    with open(os.path.join(FOLDER, name), "rb") as transcript:
        return [expanded(line) for line in transcript]


def steps(name):
    """Pairs of what the server sends, and what the client sends after it."""
    pairs, reply = [], b""
    for line in recorded(name):
        if line.startswith(b"< "):
            reply += line[2:]
        else:
            pairs.append((reply, line[2:]))
            reply = b""
    return pairs + [(reply, b"")]


def in_turn(wire, conversation, send):
    for reply, request in conversation[:-1]:
        received = wire.receive(len(reply))
        if received != reply:
            return received + b"..."
        send(request)
    wire.stop_sending()
    return b"".join(reply for reply, _ in conversation[:-1]) + wire.rest()


def whole(wire, conversation):
    return in_turn(wire, conversation, wire.send)


def byte_by_byte(wire, conversation):
    def send(line):
        for at in range(len(line)):
            wire.send(line[at : at + 1])

    return in_turn(wire, conversation, send)


def ahead(wire, conversation):
    wire.send(b"".join(request for _, request in conversation))
    wire.stop_sending()
    return wire.rest()


class TestRecorded:
    def test_the_transcripts_are_what_was_recorded(self):
        for name, digest in RECORDED.items():
            assert hashlib.md5(b"".join(recorded(name))).hexdigest() == digest, name


@pytest.mark.usefixtures("self_subtests")
class TestTranscripts:
    def check(self, manner):
        for transport in TRANSPORTS:
            for name, options in TRANSCRIPTS.items():
                with self.subtests.test(transport=transport, transcript=name):
                    conversation = steps(name)
                    expected = b"".join(reply for reply, _ in conversation)
                    with Session(transport, *FIXED, *options, image=TETRIS) as session:
                        received = manner(session.wire, conversation)
                        assert received == expected, f"differs: {len(received)} of {len(expected)} bytes"
                        assert session.status() == 0

    def test_they_are_reproduced_when_whole_lines_take_turns(self):
        self.check(whole)

    def test_they_are_reproduced_when_the_input_comes_one_byte_at_a_time(self):
        self.check(byte_by_byte)

    def test_they_are_reproduced_when_all_is_sent_ahead_in_one_write(self):
        self.check(ahead)
