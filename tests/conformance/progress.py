"""Progress of the suite: a bar on a terminal, elsewhere a line from time to time."""

import shutil
import sys
import time

PLAIN_EVERY = 30  # seconds


class Progress:
    def __init__(self, total):
        self.total, self.done, self.bad, self.frames = total, 0, 0, 0
        self.start = self.last_report = time.monotonic()
        self.terminal = sys.stdout.isatty()

    def step(self, frames, good):
        self.done, self.frames, self.bad = self.done + 1, self.frames + frames, self.bad + (not good)
        now = time.monotonic()
        if self.terminal or self.done == self.total or now - self.last_report > PLAIN_EVERY:
            self.last_report = now
            self.show(now)

    def show(self, now):
        seconds = max(now - self.start, 1e-3)
        text = (
            f"{self.done}/{self.total} runs, {self.frames:,} frames, {self.frames / seconds:,.0f}/s, "
            f"{self.bad} not identical, {seconds:.0f} s"
        )
        if not self.terminal:
            print(text, flush=True)
            return
        room = max(shutil.get_terminal_size().columns - len(text) - 4, 0)
        filled = room * self.done // max(self.total, 1)
        sys.stdout.write(f"\r[{'#' * filled}{'.' * (room - filled)}] {text}\033[K" + "\n" * (self.done == self.total))
        sys.stdout.flush()

    def say(self, text):
        if self.terminal:
            sys.stdout.write("\r\033[K")
        print(text, flush=True)
