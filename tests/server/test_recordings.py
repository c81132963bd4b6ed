"""Recordings on a running server: what they contain at a limit, and that they block no client."""

import os
import resource
import select
import statistics
import subprocess
import tempfile
import threading
import time
import unittest

from harness import BINARY, PATIENCE, ask, connect_tcp, connect_unix, main, run, sanitized, serve, \
    thread_sanitized, Server

LIMIT = 1000000
SLACK = 2  # seconds, for a busy machine
KINDS = {"y4m": ["film.y4m"], "gif": ["film.gif"], "wav": ["film.wav"], "png": ["film"], "y4m,wav": ["film.wav", "film.y4m"]}


def requests(kind):
    """A recording of more than LIMIT bytes, of any kind."""
    return (b"load beamfall sticky=0 max_episode_frames=0\nsave root\nrecord %s film\n" % kind.encode() +
            b"act FIRE*1000\nrestore root\n" * 4 + b"record stop\nact NOOP\n")


class Limits(unittest.TestCase):
    def check(self, kind, lines, folder, reason):
        told = [line for line in lines if line.startswith(b"ok recording_ended=" + reason + b" ")]
        self.assertEqual(len(told), 1, lines)
        self.assertRegex(lines[-2], b"^ok recorded=film.* frames=[1-9][0-9]* .* complete=0 recording_ended=" + reason + b"$")
        self.assertTrue(lines[-1].startswith(b"ok "))
        self.assertEqual(sorted(os.listdir(folder)), KINDS[kind])

    def test_what_fits_is_kept(self):
        for kind in KINDS:
            with self.subTest(kind=kind), tempfile.TemporaryDirectory() as folder:
                lines = run("serve", "--stdio", "--record-dir", folder, "--record-limit", str(LIMIT),
                            data=requests(kind))[1].splitlines()
                self.check(kind, lines, folder, b"limit")
                size = int(lines[-2].split(b"bytes=")[1].split()[0])
                self.assertLessEqual(size, LIMIT)
                self.assertEqual(size, sum(os.path.getsize(os.path.join(path, name))
                                           for path, _, names in os.walk(folder) for name in names))

    def test_what_the_disk_takes_is_kept(self):
        for kind, most in {"y4m": LIMIT, "gif": LIMIT // 10, "wav": LIMIT // 10, "y4m,wav": LIMIT}.items():
            with self.subTest(kind=kind), tempfile.TemporaryDirectory() as folder:
                done = subprocess.run([BINARY, "serve", "--stdio", "--record-dir", folder], input=requests(kind),
                                      capture_output=True, timeout=PATIENCE,
                                      preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (most, most)))
                self.check(kind, done.stdout.splitlines(), folder, b"disk")
                self.assertEqual(done.returncode, 0)
                with open(os.path.join(folder, KINDS[kind][-1]), "rb") as file:
                    film = file.read()
                if kind == "gif":
                    self.assertTrue(film.endswith(b"\0;"))
                elif kind == "wav":
                    self.assertEqual((len(film) - 44) % 512, 0)
                    self.assertEqual(int.from_bytes(film[40:44], "little"), len(film) - 44)
                else:
                    self.assertEqual((len(film) - 39) % (6 + 3 * 320 * 210), 0)

    def test_where_nothing_fits_there_is_nothing(self):
        with tempfile.TemporaryDirectory() as folder:
            lines = run("serve", "--stdio", "--record-dir", folder, "--record-limit", "30",
                        data=b"load beamfall\nrecord gif film\nact NOOP\nrecord stop\n")[1].splitlines()
            self.assertIn(b"error recording the recording has reached its limit of 30 bytes", lines[1])
            self.assertEqual(lines[3], b"error recording nothing is being recorded")
            self.assertEqual(os.listdir(folder), [])


class Others(unittest.TestCase):
    MOST = 0.2  # seconds, on a busy machine; the pictures of one request of the other client take longer than a second

    def test_they_do_not_wait_for_pictures(self):
        with serve("--threads", "1", "--record-dir", ".", "--max-request-frames", "100000000") as server:
            recorder, other = connect_tcp(server.port()), connect_tcp(server.port())
            for wire in (recorder, other):
                ask(wire, b"load beamfall seed=1 max_episode_frames=0")
            ask(recorder, b"observe frames")
            ask(recorder, b"save root")
            self.assertEqual(ask(recorder, b"record png film"), b"ok recording=film\n")
            recorder.send(b"act FIRE*600\nrestore root\n" * 1000)
            times = []
            for _ in range(40):
                time.sleep(0.01)
                start = time.monotonic()
                ask(other, b"act NOOP")
                times.append(time.monotonic() - start)
            self.assertLess(statistics.median(times), self.MOST)
            recorder.close()
            other.close()

    def test_what_a_client_that_left_has_recorded_is_kept(self):
        with Server("serve", "--listen", "unix:s", "--record-dir", ".") as server:
            server.wait_for("listening")
            wire = connect_unix(server.path("s"))
            for line in (b"load beamfall sticky=0", b"record gif film", b"act FIRE*100"):
                self.assertTrue(ask(wire, line).startswith(b"ok "))
            wire.close()
            deadline = time.monotonic() + PATIENCE
            while not os.path.exists(server.path("film.gif")) and time.monotonic() < deadline:
                time.sleep(0.005)
            with open(server.path("film.gif"), "rb") as film:
                self.assertTrue(film.read().endswith(b"\0;"))
            self.assertEqual(server.stop(), 0)

    def test_what_many_record_is_kept_at_the_end(self):
        with Server("serve", "--listen", "unix:s", "--record-dir", ".", "--grace", "0") as server:
            server.wait_for("listening")
            wires = [connect_unix(server.path("s")) for _ in range(8)]

            def play(number):
                for line in (b"load beamfall sticky=0", b"record wav,gif film%d" % number, b"act FIRE*100"):
                    ask(wires[number], line)
            threads = [threading.Thread(target=play, args=(number,)) for number in range(len(wires))]
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join()
            self.assertEqual(server.stop(), 0)
            names = sorted(name for name in os.listdir(server.folder) if "film" in name)
            self.assertEqual(names, sorted(f"film{n}.{kind}" for n in range(len(wires)) for kind in ("gif", "wav")))
            for wire in wires:
                wire.close()


@unittest.skipIf(sanitized() or thread_sanitized(), "a sanitizer wants to be loaded first")
class HangingDisk(unittest.TestCase):
    """fsync never returns."""

    def serve(self, *options):
        return Server("serve", "--threads", "1", "--listen", "unix:s", "--record-dir", ".", "--grace", "1", *options,
                      LD_PRELOAD=os.environ["RACEBEAM_HANGING_DISK"])

    def begin(self, server, kind):
        wire = connect_unix(server.path("s"))
        for line in (b"load beamfall sticky=0 max_episode_frames=0", b"record %s film" % kind, b"act FIRE*40"):
            self.assertTrue(ask(wire, line).startswith(b"ok "))
        return wire

    def check_others_play(self, server):
        other = connect_unix(server.path("s"))
        for line in [b"load beamfall"] + [b"act NOOP"] * 20:
            self.assertTrue(ask(other, line).startswith(b"ok "))
        other.close()

    def check_it_ends(self, server):
        start = time.monotonic()
        self.assertEqual(server.stop(), 0)
        self.assertLess(time.monotonic() - start, 1 + 1 + SLACK)

    def test_a_client_leaves(self):
        with self.serve() as server:
            server.wait_for("listening")
            for kind in (b"gif", b"png"):  # as many as there are threads that write
                self.begin(server, kind).close()
            waiting = connect_unix(server.path("s"))
            waiting.send(b"load beamfall\nrecord wav one-more\n")
            self.assertTrue(waiting.line().startswith(b"ok "))
            self.check_others_play(server)
            self.check_it_ends(server)
            waiting.close()

    def test_a_session_stops_its_recording(self):
        with self.serve() as server:
            server.wait_for("listening")
            wire = self.begin(server, b"gif")
            wire.send(b"record stop\n")
            self.check_others_play(server)
            self.check_it_ends(server)
            wire.close()

    def test_a_recording_reaches_its_limit(self):
        with self.serve("--record-limit", "1000000") as server:
            server.wait_for("listening")
            wire = self.begin(server, b"y4m")
            for _ in range(10):
                self.assertTrue(ask(wire, b"act FIRE*40").startswith(b"ok "))
            self.check_others_play(server)
            self.check_it_ends(server)
            wire.close()

    def test_what_is_not_written_yet_counts_when_its_client_has_left(self):
        with self.serve("--max-memory", "64M") as server:
            server.wait_for("listening")
            stays = connect_unix(server.path("s"))
            ask(stays, b"load beamfall")
            for number in range(60):
                wire = connect_unix(server.path("s"))
                reply = ask(wire, b"load beamfall")
                wire.send(b"record y4m,wav film%d\n" % number)
                if reply.startswith(b"ok ") and select.select([wire], [], [], 0.2)[0]:  # not once both threads hang
                    reply = wire.line()
                if reply.startswith(b"error "):
                    break
                wire.close()
            self.assertIn(number, range(4, 59))
            self.assertRegex(ask(stays, b"record y4m,wav mine"), b"^error limit a recording would take about ")
            for left in (stays, wire):
                left.close()
            self.check_it_ends(server)

    def test_a_session_stays(self):
        with self.serve() as server:
            server.wait_for("listening")
            wire = self.begin(server, b"gif")
            self.check_others_play(server)
            self.check_it_ends(server)
            wire.close()


if __name__ == "__main__":
    main()
