#!/usr/bin/env python3
"""Takes the steps of a file with the client in Python, and prints what came of each: runner.py FILE."""

import os
import pathlib
import re
import ssl
import sys
import time
import zlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "python/single_file"))
import client  # noqa: E402

LONGEST_REPLY = 1 << 20


def text_of(value):
    return f"{len(value)}:{zlib.adler32(value):08x}" if isinstance(value, bytes) else str(value)


def outcome(action):
    """What `action` returns, or the word for its failure."""
    try:
        return action()
    except client.Refused as error:
        return f"error {error.code}"
    except TimeoutError:
        return "timeout"
    except OSError:
        return "lost"
    except ValueError:
        return "invalid"


class Runner:
    def __init__(self):
        self.session = None
        self.variables = dict(os.environ)
        self.timeout, self.trusted, self.stack = 60.0, None, None
        self.sent, self.last = [], {}

    def connected(self, address, token=None):
        return client.connect(address, token=token, timeout=self.timeout, longest_reply=LONGEST_REPLY, tls=self.trusted)

    def reply(self):
        """The next reply, as it is printed."""
        command = self.sent.pop(0)
        groups = self.session.receive_values()
        self.last = groups[0]
        if self.stack:
            self.follow(command, groups[0])
        return "ok" + " |".join("".join(f" {key}={text_of(group[key])}" for key in sorted(group)) for group in groups)

    def follow(self, command, group):
        """Shows the client's stack of screens, under the name that the server gives to such a field."""
        field, depth, stack = self.stack
        if command in ("reset", "load", "observe"):
            stack.clear()
        if field in group:
            group[f"{field}x{depth}"] = stack.push(group.pop(field))

    # The steps

    def section(self, name, *_):
        self.stack, self.timeout, self.trusted, self.sent = None, 60.0, None, []
        print(f"section {name}")

    def connect(self, *words):
        self.close()
        self.session = self.connected(*words)
        return "connected"

    def another(self, *words):
        self.connected(*words).close_connection()
        return "connected"

    def connections(self, count, address):
        for _ in range(int(count)):
            self.connected(address).close_connection()
        return "connected"

    def launch(self):
        self.close()
        self.session = client.launch(program=os.environ["RACEBEAM_BINARY"])
        return "connected"

    def close(self):
        if self.session:
            self.session.close_connection()

    def ask(self, *words):
        self.send(*words)
        return self.reply()

    def send(self, *words):
        self.session.send(*words)
        self.sent.append(words[0] if words else "")

    def receive(self, count):
        for _ in range(int(count)):
            print(outcome(self.reply))

    def picture(self, path):
        self.session.save_png(path)
        return f"picture {text_of(pathlib.Path(path).read_bytes())}"

    def keep(self, variable, key):
        self.variables[variable] = str(self.last[key])

    def trust(self, path):
        self.trusted = ssl.create_default_context(cafile=path)

    def wait(self, seconds):
        time.sleep(float(seconds))

    def set_timeout(self, seconds):
        self.timeout = float(seconds)

    def set_stack(self, field, depth):
        self.stack = (field, depth, client.Stack(int(depth)))

    def time(self, steps, ahead, *words):
        """Prints the seconds that `steps` requests take, sent in groups of `ahead`."""
        start = time.perf_counter()
        for _ in range(int(steps) // int(ahead)):
            for _ in range(int(ahead)):
                self.session.send(*words)
            for _ in range(int(ahead)):
                self.session.receive_values()
        return f"time {ahead} {time.perf_counter() - start:.6f}"

    NAMES = {">": "ask", "timeout": "set_timeout", "stack": "set_stack"}

    def take(self, line):
        word, *words = re.sub(r"\$(\w+)", lambda found: self.variables[found[1]], line).split()
        printed = outcome(lambda: getattr(self, self.NAMES.get(word, word))(*words))
        if printed:
            print(printed)


def main():
    runner = Runner()
    with open(sys.argv[1]) as file:
        for line in file:
            if line.strip() and not line.startswith("#"):
                runner.take(line)
    runner.close()


if __name__ == "__main__":
    main()
