"""A game in a terminal, and a session beside it that sees the same game."""

import os
import socket
import time

import pytest
from harness import BINARY, PATIENCE
from terminal import Terminal


def environment(**more):
    return {key: value for key, value in os.environ.items() if not key.startswith("RACEBEAM_")} | more


class Wire:
    """A session over a Unix socket."""

    def __init__(self, path):
        until = time.monotonic() + PATIENCE
        while not os.path.exists(path) and time.monotonic() < until:
            time.sleep(0.01)
        self.socket = socket.socket(socket.AF_UNIX)
        self.socket.settimeout(PATIENCE)
        self.socket.connect(path)
        self.file = self.socket.makefile("rw", newline="\n")

    def ask(self, line):
        self.file.write(line + "\n")
        self.file.flush()
        words = self.file.readline().split()
        assert words[0] == "ok", words
        return dict(word.split("=", 1) for word in words if "=" in word)

    def close(self):
        self.file.close()
        self.socket.close()

    def watch(self, name):
        """Asks for the picture of a shared session. Waits for the next copy; in a pause, when none comes, the last copy
        counts."""
        request = f"watch {name} screen:hex palette"
        before = self.ask(request)["frame"]
        until = time.monotonic() + 0.2
        while (reply := self.ask(request))["frame"] == before and time.monotonic() < until:
            time.sleep(0.005)
        return reply

    def picture(self, name):
        """The pixels of a shared session, as red, green and blue."""
        screen = self.watch(name)
        palette = bytes.fromhex(screen["palette"])
        return [tuple(palette[3 * value : 3 * value + 3]) for value in bytes.fromhex(screen["screen"])]


@pytest.mark.usefixtures("self_cleanup", "self_folder")
class InTerminal:
    def open(self, *words, **properties):
        terminal = Terminal([BINARY, *words], environment=environment(TMPDIR=self.folder, TERM="xterm"), **properties)
        self.cleanup(terminal.close)
        return terminal

    def play(self, *words, **properties):
        """A game whose server others can watch."""
        path = os.path.join(self.folder, "watch")
        terminal = self.open(
            "play", "--terminal", "--watch", "all", "--grace", "0", "--listen", f"unix:{path}", *words, **properties
        )
        terminal.wait_until(lambda: "score" in terminal.line(-1), "a game")
        wire = Wire(path)
        self.cleanup(wire.close)
        return terminal, wire, wire.ask("shared")["name"]

    def quit(self, terminal):
        terminal.type(b"q")
        assert terminal.end() == 0
        assert terminal.is_restored(), terminal.modes

    def press(self, terminal, wire, name, keys, action):
        """Types keys, as a key that is held repeats itself, until they have become an action."""

        def acts():
            terminal.type(keys)
            return self.action(wire, name) == action

        terminal.wait_until(acts, action)

    def action(self, wire, name):
        return wire.ask(f"watch {name} ram")["action"]
