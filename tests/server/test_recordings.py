"""Recordings and logs on a running server: what they contain at a limit, and that they block no client."""

import os
import re
import resource
import select
import shutil
import statistics
import subprocess
import tempfile
import threading
import time
import unittest

from harness import (
    BINARY,
    PATIENCE,
    Server,
    ask,
    connect_tcp,
    connect_unix,
    main,
    run,
    sanitized,
    serve,
    thread_sanitized,
)

LIMIT = 1000000
SLACK = 2  # seconds, for a busy machine
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


class Limits(unittest.TestCase):
    def check(self, kind, lines, folder, reason):
        replies = [line for line in lines if line.startswith(b"ok recording_ended=" + reason + b" ")]
        self.assertEqual(len(replies), 1, lines)
        self.assertRegex(
            lines[-2], b"^ok recorded=film.* frames=[1-9][0-9]* .* complete=0 recording_ended=" + reason + b"$"
        )
        self.assertTrue(lines[-1].startswith(b"ok "))
        self.assertEqual(sorted(os.listdir(folder)), KINDS[kind])

    def test_what_fits_is_kept(self):
        for kind in KINDS:
            with self.subTest(kind=kind), tempfile.TemporaryDirectory() as folder:
                lines = run(
                    "serve", "--stdio", "--record-dir", folder, "--record-limit", str(LIMIT), data=requests(kind)
                )[1].splitlines()
                self.check(kind, lines, folder, b"limit")
                size = int(lines[-2].split(b"bytes=")[1].split()[0])
                self.assertLessEqual(size, LIMIT)
                self.assertEqual(
                    size,
                    sum(
                        os.path.getsize(os.path.join(path, name))
                        for path, _, names in os.walk(folder)
                        for name in names
                    ),
                )

    def test_what_the_disk_takes_is_kept(self):
        for kind, limit in {"y4m": LIMIT, "gif": LIMIT // 10, "wav": LIMIT // 10, "y4m,wav": LIMIT}.items():
            with self.subTest(kind=kind), tempfile.TemporaryDirectory() as folder:
                done = subprocess.run(
                    [BINARY, "serve", "--stdio", "--record-dir", folder],
                    input=requests(kind),
                    capture_output=True,
                    timeout=PATIENCE,
                    preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)),
                )
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
            lines = run(
                "serve",
                "--stdio",
                "--record-dir",
                folder,
                "--record-limit",
                "30",
                data=b"load beamfall\nrecord gif film\nact NOOP\nrecord stop\n",
            )[1].splitlines()
            self.assertIn(b"error recording the recording has reached its limit of 30 bytes", lines[1])
            self.assertEqual(lines[3], b"error recording nothing is being recorded")
            self.assertEqual(os.listdir(folder), [])


class Logs(unittest.TestCase):
    PLAY = b"load beamfall seed=7 frame_skip=5 max_episode_frames=500\nlog mine\n" + b"reset\nact FIRE*50 UP*50\n" * 20

    def serve(self, folder, limit, data):
        done = subprocess.run(
            [BINARY, "serve", "--stdio", "--record-dir", folder],
            input=data,
            capture_output=True,
            timeout=PATIENCE,
            preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)),
        )
        self.assertEqual(done.returncode, 0)
        return done.stdout.splitlines()

    def test_a_full_disk_ends_them_and_the_session_goes_on(self):
        for limit, logged in ((200, 0), (900, 4)):  # rows have more than 150 bytes each, and the line of columns 149
            with self.subTest(limit=limit), tempfile.TemporaryDirectory() as folder:
                lines = self.serve(folder, limit, self.PLAY + b"log stop\nact NOOP\n")
                self.assertEqual(sum(b"log_ended=disk" in line for line in lines[:-2]), 1, lines)
                count, unlogged = map(int, re.match(rb"ok logged=(\d+) unlogged=(\d+) ", lines[-2]).groups())
                self.assertLessEqual(count, logged)
                self.assertEqual(count + unlogged, 20)
                self.assertTrue(lines[-2].endswith(b" complete=0 log_ended=disk"), lines[-2])
                self.assertTrue(lines[-1].startswith(b"ok "))
                with open(os.path.join(folder, "mine/results.csv")) as file:
                    self.assertEqual(len(file.read().splitlines()), 1 + count)
                logs = [name for _, _, names in os.walk(folder) for name in names if name.endswith(".episode")]
                self.assertEqual(len(logs), count)

    def test_where_nothing_fits_there_is_nothing(self):
        with tempfile.TemporaryDirectory() as folder:
            lines = self.serve(folder, 10, b"load beamfall seed=7\nlog mine\nact NOOP\n")
            self.assertRegex(lines[1], b"^error no-log cannot write agent.toml: File too large$")
            self.assertTrue(lines[2].startswith(b"ok "))
            self.assertEqual(os.listdir(folder), [])

    def test_two_servers_share_a_folder_but_no_unit(self):
        with tempfile.TemporaryDirectory() as folder:
            self.serve(folder, LIMIT, self.PLAY + b"log stop\n")
            again = self.serve(folder, LIMIT, self.PLAY + b"log stop\n")
            self.assertRegex(again[1], b"^error no-log mine has the unit beamfall-agent-1 already; ")
            other = self.serve(folder, LIMIT, self.PLAY.replace(b"mine", b"mine trial=2") + b"log stop\n")
            self.assertRegex(other[-1], b"^ok logged=20 unlogged=0 ")
            done = subprocess.run([BINARY, "verify", os.path.join(folder, "mine")], capture_output=True)
            self.assertIn(b"40 rows confirmed, 0 wrong", done.stdout)

    def test_what_a_client_that_left_has_played_is_kept(self):
        with tempfile.TemporaryDirectory() as folder:
            self.serve(folder, LIMIT, self.PLAY)
            done = subprocess.run([BINARY, "verify", os.path.join(folder, "mine")], capture_output=True)
            self.assertIn(b"20 rows confirmed, 0 wrong", done.stdout)


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


FAKE = """#!/bin/sh
for word; do last=$word; done
%s
"""
COPY = 'cat > "${last#file:}"'
WITH_FFMPEG = unittest.skipUnless(shutil.which("ffmpeg"), "needs ffmpeg")


class Encoded(unittest.TestCase):
    """Films that ffmpeg makes. Where it is not to work, a script stands for it."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.films, self.tools = os.path.join(folder.name, "films"), os.path.join(folder.name, "tools")
        os.mkdir(self.films)
        os.mkdir(self.tools)

    def install(self, script):
        path = os.path.join(self.tools, "ffmpeg")
        with open(path, "w") as file:
            file.write(FAKE % script)
        os.chmod(path, 0o755)

    def record(self, requests, *options, before=None, path=None):
        done = subprocess.run(
            [BINARY, "serve", "--stdio", "--record-dir", self.films, *options],
            input=requests,
            capture_output=True,
            timeout=PATIENCE,
            preexec_fn=before,
            env=os.environ | {"PATH": path or f"{self.tools}:{os.environ['PATH']}"},
        )
        self.assertEqual(done.returncode, 0)
        return done.stdout.splitlines()

    def decoded(self, name, *options):
        return subprocess.run(
            ["ffmpeg", "-v", "error", "-i", os.path.join(self.films, name), *options, "pipe:1"],
            capture_output=True,
            check=True,
            timeout=PATIENCE,
        ).stdout

    def frames(self, name):
        """How many frames a film has."""
        return len(re.findall(rb"^0,", self.decoded(name, "-map", "0:v", "-c", "copy", "-f", "framecrc"), re.MULTILINE))

    def last_frame(self, name):
        """The last frame of a film, decoded: 640 x 420 pixels of red, green and blue."""
        return self.decoded(name, "-f", "rawvideo", "-pix_fmt", "rgb24")[-3 * 640 * 420 :]

    def test_ffmpeg_gets_every_frame_and_writes_only_the_file(self):
        self.install('echo "$@" > "$(dirname "$0")/words"; ' + COPY)
        lines = self.record(b"load beamfall sticky=0\nrecord webm film\nact FIRE*5\nrecord stop\n")
        size = os.path.getsize(os.path.join(self.films, "film.webm"))
        self.assertEqual(lines[-1], b"ok recorded=film.webm frames=5 bytes=%d complete=1" % size)
        self.assertEqual(os.listdir(self.films), ["film.webm"])
        with open(os.path.join(self.films, "film.webm"), "rb") as film:
            self.assertEqual(film.read().count(b"00db"), 5)
        with open(os.path.join(self.tools, "words")) as words:
            self.assertRegex(words.read(), f" -y file:{self.films}/\\.film\\.webm\\.[A-Za-z0-9]{{6}}\n$")

    def test_a_server_without_ffmpeg_says_so(self):
        lines = self.record(b"load beamfall\nrecord mp4 film\nact FIRE\nrecord gif film\n", path=self.tools)
        self.assertEqual(lines[1], b"error recording ffmpeg is not installed: the PATH has no such program")
        self.assertEqual(lines[3], b"ok recording=film.gif")
        self.assertEqual(os.listdir(self.films), ["film.gif"])

    def test_when_ffmpeg_dies_the_game_and_other_files_remain(self):
        self.install('head -c 200000 > "${last#file:}"; echo "no space left" >&2; exit 1')
        play = b"load beamfall sticky=0\nrecord %s film\n" + b"act FIRE*30\n" * 20 + b"record stop\nact NOOP\n"
        lines = self.record(play % b"webm")
        self.assertEqual(sum(b"recording_ended=encoder" in line for line in lines[:-2]), 1)
        self.assertEqual(lines[-2], b"error recording ffmpeg failed: no space left; nothing was kept")
        self.assertTrue(lines[-1].startswith(b"ok reward="))
        self.assertEqual(os.listdir(self.films), [])
        lines = self.record(play % b"wav,mp4")
        self.assertRegex(lines[-2], b"^ok recorded=film.wav frames=[1-9].* complete=0 recording_ended=encoder$")
        self.assertEqual(os.listdir(self.films), ["film.wav"])

    def contents(self, path):
        """The bytes of a file that the encoder makes in its own time."""
        deadline = time.monotonic() + PATIENCE
        while not os.path.exists(path) and time.monotonic() < deadline:
            time.sleep(0.01)
        with open(path) as file:
            return file.read()

    def test_an_encoder_that_never_ends_delays_no_other_and_is_killed(self):
        self.install('cd "$(dirname "$0")"; echo $$ > pid.part; mv pid.part pid; exec sleep 1000')
        with Server(
            "serve",
            "--listen",
            "unix:s",
            "--record-dir",
            self.films,
            "--grace",
            "0",
            PATH=f"{self.tools}:{os.environ['PATH']}",
        ) as server:
            server.wait_for("listening")
            recorder, other = connect_unix(server.path("s")), connect_unix(server.path("s"))
            for wire in (recorder, other):
                ask(wire, b"load beamfall")
            ask(recorder, b"record webm film")
            recorder.send(b"act FIRE*600\n")
            for _ in range(20):
                self.assertTrue(ask(other, b"act NOOP").startswith(b"ok "))
            process = int(self.contents(os.path.join(self.tools, "pid")))
            recorder.close()
            other.close()
            self.assertEqual(server.stop(), 0)
        deadline = time.monotonic() + PATIENCE
        while os.path.exists(f"/proc/{process}") and time.monotonic() < deadline:
            time.sleep(0.01)
        self.assertFalse(os.path.exists(f"/proc/{process}"))
        self.assertEqual(os.listdir(self.films), [])

    @WITH_FFMPEG
    def test_a_film_shows_what_was_played_and_sounds(self):
        lines = self.record(b"load beamfall sticky=0\nrecord webm,mp4 film\nact FIRE*60\nlook rgb:hex\nrecord stop\n")
        self.assertRegex(lines[-1], b"^ok recorded=film.webm,film.mp4 frames=60 bytes=[0-9]+ complete=1$")
        pixels = bytes.fromhex(lines[-2].split(b"rgb=")[1].split()[0].decode())
        for name in ("film.webm", "film.mp4"):
            with self.subTest(name):
                self.assertEqual(self.frames(name), 60)
                frame = self.last_frame(name)
                pictures = [
                    frame[3 * (640 * (2 * row) + 4 * column + 1) + part]
                    for row in range(210)
                    for column in range(160)
                    for part in range(3)
                ]
                self.assertLess(statistics.mean(abs(a - b) for a, b in zip(pictures, pixels)), 8)
                sound = self.decoded(name, "-f", "u8", "-ar", "30720")
                self.assertAlmostEqual(len(sound) / 30720, 1, delta=0.1)
                self.assertGreater(max(sound) - min(sound), 10)

    @WITH_FFMPEG
    def test_what_fits_is_a_whole_film(self):
        for kind in ("webm", "mp4"):
            lines = self.record(
                b"load beamfall sticky=0 max_episode_frames=0\nsave root\nrecord %s film\n" % kind.encode()
                + b"act FIRE*400\nrestore root\n" * 4
                + b"record stop\n",
                "--record-limit",
                "400000",
            )
            self.assertIn(b" recording_ended=limit", lines[-1])
            size = os.path.getsize(os.path.join(self.films, f"film.{kind}"))
            self.assertLessEqual(size, 400000)
            frames = int(re.search(rb" frames=(\d+) bytes=%d " % size, lines[-1])[1])
            self.assertEqual(self.frames(f"film.{kind}"), frames)

    @WITH_FFMPEG
    def test_a_full_disk_is_an_error_that_leaves_nothing(self):
        lines = self.record(
            b"load beamfall sticky=0\nrecord mp4 film\n" + b"act FIRE*200\n" * 10 + b"record stop\nact NOOP\n",
            before=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (50000, 50000)),
        )
        self.assertRegex(lines[-2], b"^error recording ffmpeg failed: .*; nothing was kept$")
        self.assertTrue(lines[-1].startswith(b"ok "))
        self.assertEqual(os.listdir(self.films), [])


@unittest.skipIf(sanitized() or thread_sanitized(), "a sanitizer wants to be loaded first")
class HangingDisk(unittest.TestCase):
    """fsync never returns."""

    def serve(self, *options):
        hanging_disk = os.environ["RACEBEAM_HANGING_DISK"]
        self.assertTrue(os.path.exists(hanging_disk), hanging_disk)  # else the loader ignores it
        return Server(
            "serve",
            "--threads",
            "1",
            "--listen",
            "unix:s",
            "--record-dir",
            ".",
            "--grace",
            "1",
            *options,
            LD_PRELOAD=hanging_disk,
        )

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
            for wire_to_close in (stays, wire):
                wire_to_close.close()
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
