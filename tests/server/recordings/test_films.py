"""Films that an encoder writes on a running server: what they contain, and that they block no client."""

import os
import re
import resource
import statistics
import subprocess
import time

import pytest
from harness import BINARY, PATIENCE, Server, ask, connect_unix

FAKE = """#!/bin/sh
for word; do last=$word; done
%s
"""
COPY = 'cat > "${last#file:}"'


class TestEncoded:
    """Films that ffmpeg makes. Where it is not to work, a script stands for it."""

    @pytest.fixture(autouse=True)
    def set_up(self, tmp_path):
        self.films, self.tools = os.path.join(tmp_path, "films"), os.path.join(tmp_path, "tools")
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
        assert done.returncode == 0
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
        assert lines[-1] == b"ok recorded=film.webm frames=5 bytes=%d complete=1" % size
        assert os.listdir(self.films) == ["film.webm"]
        with open(os.path.join(self.films, "film.webm"), "rb") as film:
            assert film.read().count(b"00db") == 5
        with open(os.path.join(self.tools, "words")) as words:
            assert re.search(f" -y file:{self.films}/\\.film\\.webm\\.[A-Za-z0-9]{{6}}\n$", words.read())

    def test_a_server_without_ffmpeg_says_so(self):
        lines = self.record(b"load beamfall\nrecord mp4 film\nact FIRE\nrecord gif film\n", path=self.tools)
        assert lines[1] == b"error recording ffmpeg is not installed: the PATH has no such program"
        assert lines[3] == b"ok recording=film.gif"
        assert os.listdir(self.films) == ["film.gif"]

    def test_when_ffmpeg_dies_the_game_and_other_files_remain(self):
        self.install('head -c 200000 > "${last#file:}"; echo "no space left" >&2; exit 1')
        play = b"load beamfall sticky=0\nrecord %s film\n" + b"act FIRE*30\n" * 20 + b"record stop\nact NOOP\n"
        lines = self.record(play % b"webm")
        assert sum(b"recording_ended=encoder" in line for line in lines[:-2]) == 1
        assert lines[-2] == b"error recording ffmpeg failed: no space left; nothing was kept"
        assert lines[-1].startswith(b"ok reward=")
        assert os.listdir(self.films) == []
        lines = self.record(play % b"wav,mp4")
        assert re.search(b"^ok recorded=film.wav frames=[1-9].* complete=0 recording_ended=encoder$", lines[-2])
        assert os.listdir(self.films) == ["film.wav"]

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
                assert ask(other, b"act NOOP").startswith(b"ok ")
            process = int(self.contents(os.path.join(self.tools, "pid")))
            recorder.close()
            other.close()
            assert server.stop() == 0
        deadline = time.monotonic() + PATIENCE
        while os.path.exists(f"/proc/{process}") and time.monotonic() < deadline:
            time.sleep(0.01)
        assert not os.path.exists(f"/proc/{process}")
        assert os.listdir(self.films) == []

    @pytest.mark.needs_programs("ffmpeg")
    def test_a_film_shows_what_was_played_and_sounds(self, subtests):
        lines = self.record(b"load beamfall sticky=0\nrecord webm,mp4 film\nact FIRE*60\nlook rgb:hex\nrecord stop\n")
        assert re.search(b"^ok recorded=film.webm,film.mp4 frames=60 bytes=[0-9]+ complete=1$", lines[-1])
        pixels = bytes.fromhex(lines[-2].split(b"rgb=")[1].split()[0].decode())
        for name in ("film.webm", "film.mp4"):
            with subtests.test(name):
                assert self.frames(name) == 60
                frame = self.last_frame(name)
                pictures = [
                    frame[3 * (640 * (2 * row) + 4 * column + 1) + part]
                    for row in range(210)
                    for column in range(160)
                    for part in range(3)
                ]
                assert statistics.mean(abs(a - b) for a, b in zip(pictures, pixels)) < 8
                sound = self.decoded(name, "-f", "u8", "-ar", "30720")
                assert abs(len(sound) / 30720 - 1) <= 0.1
                assert max(sound) - min(sound) > 10

    @pytest.mark.needs_programs("ffmpeg")
    def test_what_fits_is_a_whole_film(self):
        for kind in ("webm", "mp4"):
            lines = self.record(
                b"load beamfall sticky=0 max_episode_frames=0\nsave root\nrecord %s film\n" % kind.encode()
                + b"act FIRE*400\nrestore root\n" * 4
                + b"record stop\n",
                "--record-limit",
                "400000",
            )
            assert b" recording_ended=limit" in lines[-1]
            size = os.path.getsize(os.path.join(self.films, f"film.{kind}"))
            assert size <= 400000
            frames = int(re.search(rb" frames=(\d+) bytes=%d " % size, lines[-1])[1])
            assert self.frames(f"film.{kind}") == frames

    @pytest.mark.needs_programs("ffmpeg")
    def test_a_full_disk_is_an_error_that_leaves_nothing(self):
        lines = self.record(
            b"load beamfall sticky=0\nrecord mp4 film\n" + b"act FIRE*200\n" * 10 + b"record stop\nact NOOP\n",
            before=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (50000, 50000)),
        )
        assert re.search(b"^error recording ffmpeg failed: .*; nothing was kept$", lines[-2])
        assert lines[-1].startswith(b"ok ")
        assert os.listdir(self.films) == []
