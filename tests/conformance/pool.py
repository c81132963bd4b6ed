"""Runs work on all processors, a process for each item. A process that dies or hangs affects no other."""

import itertools
import multiprocessing
import multiprocessing.connection
import os
import signal
import tempfile
import time

CONTEXT = multiprocessing.get_context("fork")
INTERRUPTS = (signal.SIGINT, signal.SIGTERM)


class Task:
    def __init__(self, function, item, patience):
        self.item, self.deadline = item, time.monotonic() + patience
        self.errors = tempfile.TemporaryFile()
        self.inbox, outbox = CONTEXT.Pipe(duplex=False)
        self.process = CONTEXT.Process(target=self.work, args=(function, outbox))
        self.process.start()
        outbox.close()

    def work(self, function, outbox):
        """In the child. It gets its own process group: an interrupt only reaches the parent, which then ends
        the group."""
        os.setpgid(0, 0)
        for number in INTERRUPTS:
            signal.signal(number, signal.SIG_DFL)
        signal.pthread_sigmask(signal.SIG_UNBLOCK, INTERRUPTS)
        for stream in (1, 2):
            os.dup2(self.errors.fileno(), stream)
        outbox.send(function(self.item))

    def result(self):
        """The result of the function, or a sentence (str) if it failed."""
        try:
            result = self.inbox.recv()
        except EOFError:
            self.process.join()
            result = f"the process ended with status {self.process.exitcode}: {self.last_words()}"
        self.close()
        return result

    def last_words(self):
        self.errors.seek(0)
        lines = self.errors.read().decode(errors="replace").split("\n")
        return next((line for line in reversed(lines) if line.strip()), "no message")

    def kill(self):
        try:
            os.killpg(self.process.pid, signal.SIGKILL)
        except ProcessLookupError:
            self.process.kill()  # it has no group yet, or is gone
        self.close()

    def close(self):
        self.process.join()
        self.inbox.close()
        self.errors.close()


def ready_of(tasks):
    """The inboxes of those that have ended, after a second at the latest. Interrupts come through here only."""
    signal.pthread_sigmask(signal.SIG_UNBLOCK, INTERRUPTS)
    try:
        return multiprocessing.connection.wait([task.inbox for task in tasks], timeout=1)
    finally:
        signal.pthread_sigmask(signal.SIG_BLOCK, INTERRUPTS)


def results(function, items, jobs, patience):
    """Yields (item, result) as they are finished. A result is what `function(item)` returned, or a sentence
    if it failed.

    Interrupts are blocked but for the time that it waits: elsewhere they could end half a start of a process, or half
    a line of what the caller keeps."""
    waiting, running = iter(items), []
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, INTERRUPTS)
    try:
        while True:
            for item in itertools.islice(waiting, jobs - len(running)):
                running.append(Task(function, item, patience))
            if not running:
                return
            ready = ready_of(running)
            for task in list(running):
                late = time.monotonic() > task.deadline
                if task.inbox not in ready and not late:
                    continue
                running.remove(task)
                if task.inbox in ready:
                    yield task.item, task.result()
                else:
                    task.kill()
                    yield task.item, f"not done after {patience} seconds"
    finally:
        for task in running:
            task.kill()
        signal.pthread_sigmask(signal.SIG_SETMASK, mask)
