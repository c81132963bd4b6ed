"""On a terminal, help is folded to its width; a program gets one line."""

import errno
import fcntl
import os
import pty
import struct
import subprocess
import termios

import pytest
from harness import BINARY, PATIENCE

COLUMNS = 60


def said_on_a_terminal(requests):
    """All output of `racebeam serve --stdio` on a terminal of COLUMNS columns."""
    ours, theirs = pty.openpty()
    fcntl.ioctl(theirs, termios.TIOCSWINSZ, struct.pack("HHHH", 24, COLUMNS, 0, 0))
    server = subprocess.Popen(
        [BINARY, "serve", "--stdio"], stdin=subprocess.PIPE, stdout=theirs, stderr=subprocess.DEVNULL
    )
    os.close(theirs)
    server.stdin.write(requests)
    server.stdin.close()
    output = b""
    try:
        while piece := os.read(ours, 65536):
            output += piece
    except OSError as error:  # the end of a terminal
        if error.errno != errno.EIO:
            raise
    os.close(ours)
    server.wait(PATIENCE)
    return output.decode().replace("\r\n", "\n")


def said_to_a_program(requests):
    return subprocess.run(
        [BINARY, "serve", "--stdio"], input=requests, capture_output=True, timeout=PATIENCE
    ).stdout.decode()


class TestTerminal:
    @pytest.mark.parametrize(
        "topic", ("", "settings", "presets", "fields", "encodings", "errors", "states", "load", "sticky")
    )
    def test_help_fits_the_terminal_of_a_person(self, topic):
        request = f"help {topic}\nexit\n".encode()
        folded = said_on_a_terminal(request)
        assert max(map(len, folded.splitlines())) <= COLUMNS
        whole = said_to_a_program(request)
        assert whole.count("\n") == 2
        assert folded.replace(";", "").split() == whole.replace(";", "").split()

    def test_other_replies_are_one_line_on_a_terminal_too(self):
        requests = b"load beamfall seed=7\nsettings\nact FIRE\nexit\n"
        assert said_on_a_terminal(requests) == said_to_a_program(requests)
