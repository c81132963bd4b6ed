"""The server gives the replies in the conversations of protocol/CLASSIC.md and protocol/PROTOCOL.md."""

import os
import re
import shlex
import sys

import pytest
from harness import SOURCE, STREAMS, TRANSPORTS, Session, run

sys.path.insert(0, os.path.join(SOURCE, "tests/server/recorded"))
import replies  # noqa: E402


def conversations(path):
    """For each '$ racebeam' in the document: the command, the input, and the expected output."""
    found = []
    with open(os.path.join(SOURCE, path)) as document:
        for line in document:
            mark, text = line[4:6], line[6:]
            if not line.startswith("    "):
                continue
            if mark == "$ ":
                found.append((shlex.split(text)[1:], [], []))
            elif mark in ("> ", "< "):
                found[-1][1 if mark == "> " else 2].append(text)
    return found


def pattern(replies):
    """Matches this output. ... stands for text, and [N bytes] for bytes that follow a line."""
    text = re.escape("".join(replies)).replace(re.escape("..."), ".*")
    return re.sub(r"\\\[(\d+)\\ bytes\\\]\\\n", r"[\\s\\S]{\1}", text)


def reply(wire):
    """A line, and the bytes that follow it."""
    line = wire.line()
    raw = re.search(rb" raw=(\d+)\n\Z", line)
    return line + (wire.receive(int(raw[1])) if raw else b"")


@pytest.mark.usefixtures("self_subtests")
class TestDocuments:
    def test_the_conversations_of_the_classic_protocol_are_real(self, subtests):
        found = conversations("protocol/CLASSIC.md")
        assert found
        for command, requests, answers in found:
            with subtests.test(command=command):
                status, output, _ = run(*command, data="".join(requests).encode())
                expected = re.escape("".join(answers)).replace(re.escape("..."), "[0-9A-F]+")
                assert re.search(f"\\A{expected}\\Z", output.decode())
                assert status == 0

    def check_lines(self, converse):
        """Each conversation of the line protocol, over each transport. `converse` sends it and receives the
        replies."""
        found = conversations("protocol/PROTOCOL.md")
        assert found
        for command, requests, answers in found:
            options = [word for word in command[1:] if word != "--stdio"]
            expected = pattern(answers)
            strict = "--strict" in options  # on streams only; such a conversation ends with an error
            for transport in STREAMS if strict else TRANSPORTS:
                with self.subtests.test(command=command, said=requests, transport=transport):
                    with Session(transport, *options, image=None) as session:
                        received = converse(session.wire, [line.encode() for line in requests])
                        assert re.search(f"\\A{expected}\\Z", received.decode("latin-1"))
                        assert session.status() == int(strict)

    def test_the_conversations_of_the_line_protocol_are_real(self):
        def in_turn(wire, lines):
            answers = b""
            for line in lines:
                wire.send(line)
                if not line.startswith(b"#"):  # a comment, which has no reply
                    answer = reply(wire)
                    replies.check(line.decode(), answer.partition(b"\n")[0].decode())
                    answers += answer
            wire.stop_sending()
            return answers + wire.rest()

        self.check_lines(in_turn)

    def test_they_are_when_the_input_comes_one_byte_at_a_time(self):
        def byte_by_byte(wire, lines):
            for line in lines:
                for at in range(len(line)):
                    wire.send(line[at : at + 1])
            wire.stop_sending()
            return wire.rest()

        self.check_lines(byte_by_byte)

    def test_they_are_when_all_is_sent_ahead_in_one_write(self):
        def ahead(wire, lines):
            wire.send(b"".join(lines))
            wire.stop_sending()
            return wire.rest()

        self.check_lines(ahead)
