"""Recorded sessions of the classic server are reproduced byte for byte, however the bytes come in."""

import os
import unittest

from harness import TRANSPORTS, Session, main, rom, transcripts_folder

FOLDER = transcripts_folder()
TETRIS = rom("tetris")
FIXED = ("--seed", "123", "--sticky", "0")
TRANSCRIPTS = {
    "tetris-rle-ram-rl.txt": (),
    "tetris-full-screen.txt": ("--full-screen",),
    "tetris-rl-only-limits.txt": ("--max-episode-frames", "6", "--max-frames", "12"),
}


def steps(name):
    """Pairs of what the server sends, and what the client sends after it."""
    said, heard = [], b""
    with open(os.path.join(FOLDER, name), "rb") as transcript:
        for line in transcript:
            if line.startswith(b"< "):
                heard += line[2:]
            else:
                said.append((heard, line[2:]))
                heard = b""
    return said + [(heard, b"")]


def in_turn(wire, conversation, send):
    for heard, said in conversation[:-1]:
        received = wire.receive(len(heard))
        if received != heard:
            return received + b"..."
        send(said)
    wire.stop_sending()
    return b"".join(heard for heard, _ in conversation[:-1]) + wire.rest()


def whole(wire, conversation):
    return in_turn(wire, conversation, wire.send)


def byte_by_byte(wire, conversation):
    def send(line):
        for at in range(len(line)):
            wire.send(line[at:at + 1])
    return in_turn(wire, conversation, send)


def ahead(wire, conversation):
    wire.send(b"".join(said for _, said in conversation))
    wire.stop_sending()
    return wire.rest()


class Transcripts(unittest.TestCase):
    def check(self, manner):
        for transport in TRANSPORTS:
            for name, options in TRANSCRIPTS.items():
                with self.subTest(transport=transport, transcript=name):
                    conversation = steps(name)
                    expected = b"".join(heard for heard, _ in conversation)
                    with Session(transport, *FIXED, *options, image=TETRIS) as session:
                        received = manner(session.wire, conversation)
                        self.assertTrue(received == expected, f"differs: {len(received)} of {len(expected)} bytes")
                        self.assertEqual(session.status(), 0)

    def test_they_are_reproduced_when_whole_lines_take_turns(self):
        self.check(whole)

    def test_they_are_reproduced_when_the_input_comes_one_byte_at_a_time(self):
        self.check(byte_by_byte)

    def test_they_are_reproduced_when_all_is_sent_ahead_in_one_write(self):
        self.check(ahead)


if __name__ == "__main__":
    main(("recorded sessions", FOLDER), ("image of tetris", TETRIS))
