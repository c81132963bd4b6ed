"""Recordings and logs on a running server: what they contain at a limit, and that they block no client."""

import os
import re
import resource
import statistics
import subprocess
import tempfile
import threading
import time

import pytest
from harness import BINARY, LISTEN, PATIENCE, Server, ask, connect_nearby, connect_tcp, run, serve

LIMIT = 1000000
KINDS = {
    "y4m": ["film.y4m"],
    "gif": ["film.gif"],
    "wav": ["film.wav"],
    "png": ["film"],
    "y4m,wav": ["film.wav", "film.y4m"],
}


def requests(kind):
    """A recording of more than LIMIT bytes, of any kind."""
    return (
        b"load beamfall sticky=0 max_episode_frames=0\nsave root\nrecord %s film\n" % kind.encode()
        + b"act FIRE*1000\nrestore root\n" * 4
        + b"record stop\nact NOOP\n"
    )


class TestLimits:
    def check(self, kind, lines, folder, reason):
        replies = [line for line in lines if line.startswith(b"ok recording_ended=" + reason + b" ")]
        assert len(replies) == 1, lines
        assert re.search(
            b"^ok recorded=film.* frames=[1-9][0-9]* .* complete=0 recording_ended=" + reason + b"$", lines[-2]
        )
        assert lines[-1].startswith(b"ok ")
        assert sorted(os.listdir(folder)) == KINDS[kind]

    @pytest.mark.parametrize("kind", KINDS)
    def test_what_fits_is_kept(self, kind):
        with tempfile.TemporaryDirectory() as folder:
            lines = run("serve", "--stdio", "--record-dir", folder, "--record-limit", str(LIMIT), data=requests(kind))[
                1
            ].splitlines()
            self.check(kind, lines, folder, b"limit")
            size = int(lines[-2].split(b"bytes=")[1].split()[0])
            assert size <= LIMIT
            assert size == sum(
                os.path.getsize(os.path.join(path, name)) for path, _, names in os.walk(folder) for name in names
            )

    @pytest.mark.needs_posix
    @pytest.mark.parametrize(
        "kind, limit", {"y4m": LIMIT, "gif": LIMIT // 10, "wav": LIMIT // 10, "y4m,wav": LIMIT}.items()
    )
    def test_what_the_disk_takes_is_kept(self, kind, limit):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run(
                [BINARY, "serve", "--stdio", "--record-dir", folder],
                input=requests(kind),
                capture_output=True,
                timeout=PATIENCE,
                preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)),
            )
            self.check(kind, done.stdout.splitlines(), folder, b"disk")
            assert done.returncode == 0
            with open(os.path.join(folder, KINDS[kind][-1]), "rb") as file:
                film = file.read()
            if kind == "gif":
                assert film.endswith(b"\0;")
            elif kind == "wav":
                assert (len(film) - 44) % 512 == 0
                assert int.from_bytes(film[40:44], "little") == len(film) - 44
            else:
                assert (len(film) - 39) % (6 + 3 * 320 * 210) == 0

    @pytest.mark.needs_posix
    def test_a_full_disk_is_named_as_the_reason_for_a_missing_picture(self):
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run(
                [BINARY, "serve", "--stdio", "--record-dir", folder],
                input=b"load beamfall\nshot a\nact NOOP\n",
                capture_output=True,
                timeout=PATIENCE,
                preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (500, 500)),
            )
            _, shot, act = done.stdout.splitlines()[-3:]
            assert re.fullmatch(rb"error recording cannot write .*a\.png.*: File too large", shot), shot
            assert act.startswith(b"ok ")
            assert os.listdir(folder) == []

    def test_where_nothing_fits_there_is_nothing(self):
        with tempfile.TemporaryDirectory() as folder:
            lines = run(
                "serve",
                "--stdio",
                "--record-dir",
                folder,
                "--record-limit",
                "30",
                data=b"load beamfall\nrecord gif film\nact NOOP\nrecord stop\n",
            )[1].splitlines()
            assert b"error recording the recording has reached its limit of 30 bytes" in lines[1]
            assert lines[3] == b"error recording nothing is being recorded"
            assert os.listdir(folder) == []


class TestLogs:
    PLAY = b"load beamfall seed=7 frame_skip=5 max_episode_frames=500\nlog mine\n" + b"reset\nact FIRE*50 UP*50\n" * 20

    def serve(self, folder, limit, data):
        done = subprocess.run(
            [BINARY, "serve", "--stdio", "--record-dir", folder],
            input=data,
            capture_output=True,
            timeout=PATIENCE,
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)),
        )
        assert done.returncode == 0
        return done.stdout.splitlines()

    @pytest.mark.needs_posix
    @pytest.mark.parametrize("limit, logged", ((200, 0), (900, 4)))
    def test_a_full_disk_ends_them_and_the_session_goes_on(self, limit, logged):
        with tempfile.TemporaryDirectory() as folder:
            lines = self.serve(folder, limit, self.PLAY + b"log stop\nact NOOP\n")
            assert sum(b"log_ended=disk" in line for line in lines[:-2]) == 1, lines
            count, unlogged = map(int, re.match(rb"ok logged=(\d+) unlogged=(\d+) ", lines[-2]).groups())
            assert count <= logged
            assert count + unlogged == 20
            assert lines[-2].endswith(b" complete=0 log_ended=disk"), lines[-2]
            assert lines[-1].startswith(b"ok ")
            with open(os.path.join(folder, "mine/results.csv")) as file:
                assert len(file.read().splitlines()) == 1 + count
            logs = [name for _, _, names in os.walk(folder) for name in names if name.endswith(".episode")]
            assert len(logs) == count

    @pytest.mark.needs_posix
    def test_where_nothing_fits_there_is_nothing(self):
        with tempfile.TemporaryDirectory() as folder:
            lines = self.serve(folder, 10, b"load beamfall seed=7\nlog mine\nact NOOP\n")
            assert re.search(b"^error no-log cannot write agent.toml: File too large$", lines[1])
            assert lines[2].startswith(b"ok ")
            assert os.listdir(folder) == []

    def test_two_servers_share_a_folder_but_no_unit(self):
        with tempfile.TemporaryDirectory() as folder:
            self.serve(folder, LIMIT, self.PLAY + b"log stop\n")
            again = self.serve(folder, LIMIT, self.PLAY + b"log stop\n")
            assert re.search(b"^error no-log mine has the unit beamfall-agent-1 already; ", again[1])
            other = self.serve(folder, LIMIT, self.PLAY.replace(b"mine", b"mine trial=2") + b"log stop\n")
            assert re.search(b"^ok logged=20 unlogged=0 ", other[-1])
            done = subprocess.run([BINARY, "verify", os.path.join(folder, "mine")], capture_output=True)
            assert b"40 rows confirmed, 0 wrong" in done.stdout

    def test_what_a_client_that_left_has_played_is_kept(self):
        with tempfile.TemporaryDirectory() as folder:
            self.serve(folder, LIMIT, self.PLAY)
            done = subprocess.run([BINARY, "verify", os.path.join(folder, "mine")], capture_output=True)
            assert b"20 rows confirmed, 0 wrong" in done.stdout


class TestOthers:
    MOST = 0.2  # seconds, on a busy machine; the pictures of one request of the other client take longer than a second

    def test_they_do_not_wait_for_pictures(self):
        with serve("--threads", "1", "--record-dir", ".", "--max-request-frames", "100000000") as server:
            recorder, other = connect_tcp(server.port()), connect_tcp(server.port())
            for wire in (recorder, other):
                ask(wire, b"load beamfall seed=1 max_episode_frames=0")
            ask(recorder, b"observe frames")
            ask(recorder, b"save root")
            assert ask(recorder, b"record png film") == b"ok recording=film\n"
            recorder.send(b"act FIRE*600\nrestore root\n" * 1000)
            times = []
            for _ in range(40):
                time.sleep(0.01)
                start = time.monotonic()
                ask(other, b"act NOOP")
                times.append(time.monotonic() - start)
            assert statistics.median(times) < self.MOST
            recorder.close()
            other.close()

    def test_what_a_client_that_left_has_recorded_is_kept(self):
        with Server("serve", *LISTEN, "--record-dir", ".") as server:
            wire = connect_nearby(server)
            for line in (b"load beamfall sticky=0", b"record gif film", b"act FIRE*100"):
                assert ask(wire, line).startswith(b"ok ")
            wire.close()
            deadline = time.monotonic() + PATIENCE
            while not os.path.exists(server.path("film.gif")) and time.monotonic() < deadline:
                time.sleep(0.005)
            with open(server.path("film.gif"), "rb") as film:
                assert film.read().endswith(b"\0;")
            assert server.stop() == 0

    def test_what_many_record_is_kept_at_the_end(self):
        with Server("serve", *LISTEN, "--record-dir", ".", "--grace", "0") as server:
            wires = [connect_nearby(server) for _ in range(8)]

            def play(number):
                for line in (b"load beamfall sticky=0", b"record wav,gif film%d" % number, b"act FIRE*100"):
                    ask(wires[number], line)

            threads = [threading.Thread(target=play, args=(number,)) for number in range(len(wires))]
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join()
            assert server.stop() == 0
            names = sorted(name for name in os.listdir(server.folder) if "film" in name)
            assert names == sorted(f"film{n}.{kind}" for n in range(len(wires)) for kind in ("gif", "wav"))
            for wire in wires:
                wire.close()
