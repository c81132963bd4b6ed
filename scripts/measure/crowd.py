"""A server and a crowd of sessions on it (tests/server/wire/load_client.cpp), for scripts/load and scripts/bench
scale."""

import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time

LOAD = "load beamfall seed=1 sticky=0 max_episode_frames=0"
OBSERVE = "observe reward terminated truncated ram screen:rle"


def processor_seconds(process):
    """The seconds of all threads of a process, in the program and in the kernel. process: its number."""
    stat = pathlib.Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    return (int(stat[11]) + int(stat[12])) / os.sysconf("SC_CLK_TCK")


class Server:
    """A server for TCP on this machine, from `with` to its end. processors: those that it may use; None: all. grace: in
    seconds. port, http: where it listens; http is None without the option --http. status, warnings: its status at its
    end, and the lines of its log."""

    def __init__(self, build, *options, processors=None, grace=0, log_level="warning"):
        self.processors = processors or os.sched_getaffinity(0)
        self.folder = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        self.place = pathlib.Path(self.folder.name)
        self.command = [
            build / "racebeam",
            "serve",
            "--listen",
            "tcp://127.0.0.1:0",
            "--ready-file",
            self.place / "ready",
            "--grace",
            str(grace),
            "--log-level",
            log_level,
            *options,
        ]

    def __enter__(self):
        with open(self.place / "log", "wb") as log:
            self.process = subprocess.Popen(
                self.command,
                stdin=subprocess.DEVNULL,
                stderr=log,
                preexec_fn=lambda: os.sched_setaffinity(0, self.processors),
            )
        deadline = time.monotonic() + 60
        while not (self.place / "ready").exists():
            if time.monotonic() > deadline or self.process.poll() is not None:
                self.__exit__()
                sys.exit("load: the server did not start\n" + "\n".join(self.warnings))
            time.sleep(0.02)
        ports = map(int, re.findall(r"^[^#].*:(\d+)$", (self.place / "ready").read_text(), re.MULTILINE))
        self.port, self.http = next(ports), next(ports, None)
        return self

    def __exit__(self, *_):
        self.stop()
        self.status = self.process.wait()
        self.warnings = (self.place / "log").read_text(errors="replace").splitlines()
        self.folder.cleanup()

    def stop(self):
        """Tells the server to end, and kills it after a minute. Returns the seconds until it has ended."""
        start = time.monotonic()
        self.process.terminate()
        try:
            self.process.wait(60)
        except subprocess.TimeoutExpired:
            self.process.kill()
        return time.monotonic() - start

    def resident(self):
        """The resident memory, in KiB."""
        with open(f"/proc/{self.process.pid}/status") as status:
            return next(int(line.split()[1]) for line in status if line.startswith("VmRSS"))

    def processor_seconds(self):
        return processor_seconds(self.process.pid)


class Crowd:
    """Sessions with a game, of which `actors` act every `pause` milliseconds, from act() on, for `seconds`; the others
    wait. connects: others that connect, a second. rude: misbehaving clients of each kind."""

    def __init__(self, build, server, sessions, actors, seconds, pause, connects=0, rude=0, load=LOAD, observe=OBSERVE):
        words = [server.port, sessions, actors, seconds, pause, connects, rude, load, observe]
        self.client = subprocess.Popen(
            [build / "tests/server/load_client", *map(str, words)], stdin=subprocess.PIPE, stdout=subprocess.PIPE
        )

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.client.communicate()

    def _line(self):
        line = self.client.stdout.readline()
        if not line:
            sys.exit("load: the client failed")
        return line

    def wait(self):
        """Until all sessions are connected."""
        self._line()

    def begin(self):
        self.client.stdin.write(b"\n")
        self.client.stdin.flush()

    def end(self):
        """The latencies of the acts in microseconds, their number, the seconds, and the bytes of the replies. The
        sessions stay."""
        return json.loads(self._line())
