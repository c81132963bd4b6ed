"""racebeam render: films and pictures of the log of an episode."""

import hashlib
import os
import pathlib
import re
import signal
import stat
import subprocess
import tempfile
import time
import wave

import pytest
from harness import BINARY, PATIENCE, SOURCE

PLAN = """games = ["beamfall"]
agents = ["random"]
trials = 1
evaluation_episodes = 1
environment = "max_episode_frames=60"
"""
FAKE_FFMPEG = """#!/bin/sh
for word; do last=$word; done
{ echo "$@"; cat; } > "${last#file:}"
"""


class TestRender:
    @pytest.fixture(scope="class", autouse=True)
    @classmethod
    def set_up_class(cls, tmp_path_factory):
        folder = tmp_path_factory.mktemp("render")
        cls.place = folder
        (cls.place / "plan.toml").write_text(PLAN)
        subprocess.run(
            [BINARY, "experiment", cls.place / "plan.toml", "--into", cls.place / "results"],
            check=True,
            capture_output=True,
            timeout=PATIENCE,
        )
        (cls.log,) = (cls.place / "results" / "logs").rglob("*.episode")

    def render(self, to, log=None, *words, **more):
        done = subprocess.run(
            [BINARY, "render", log or self.log, "--to", self.place / to, *words],
            capture_output=True,
            text=True,
            timeout=PATIENCE,
            env=os.environ | more,
        )
        return done.returncode, done.stdout, done.stderr

    def test_every_frame_of_the_episode_is_there(self):
        frames = int(
            re.search(
                rb" frames=(\d+)",
                subprocess.run(
                    [
                        "python3",
                        "-c",
                        (
                            "import sys, zlib; sys.stdout.buffer.write(zlib.decompress(open(sys.argv[1], "
                            "'rb').read()[24:]))"
                        ),
                        self.log,
                    ],
                    capture_output=True,
                    check=True,
                ).stdout,
            )[1]
        )
        for name in ("a.y4m", "a.gif", "a.wav", "pictures"):
            assert self.render(name) == (0, f"{self.place / name}: {frames} frames\n", "")
        size = (self.place / "a.y4m").read_bytes()
        head, _, rest = size.partition(b"\n")
        assert head == b"YUV4MPEG2 W320 H210 F60:1 Ip A1:1 C444"
        assert len(rest) == frames * (len(b"FRAME\n") + 3 * 320 * 210)
        with wave.open(str(self.place / "a.wav")) as sound:
            assert sound.getnframes() == frames * 512
        assert len(list((self.place / "pictures").iterdir())) == frames
        assert (self.place / "a.gif").read_bytes()[:6] == b"GIF89a"

    def test_ffmpeg_makes_films_with_sound(self):
        tools = self.place / "tools"
        tools.mkdir()
        (tools / "ffmpeg").write_text(FAKE_FFMPEG)
        (tools / "ffmpeg").chmod(stat.S_IRWXU)
        path = f"{tools}:{os.environ['PATH']}"
        for name, codecs in (("b.webm", ("libvpx-vp9", "libopus")), ("b.mp4", ("libx264", "aac"))):
            assert self.render(name, PATH=path)[0] == 0
            words, stream = (self.place / name).read_bytes().split(b"\n", 1)
            assert re.search(rf" -f avi -i pipe:0 .* -c:v {codecs[0]} .* -c:a {codecs[1]} ", words.decode())
            assert stream[:4] + stream[8:12] == b"RIFFAVI "
        assert self.render("c.webm", PATH="") == (
            1,
            "",
            "racebeam: ffmpeg is not installed: the PATH has no such program\n",
        )
        assert [path for path in self.place.iterdir() if path.name.startswith(".")] == []

    def test_a_signal_leaves_nothing_behind(self, subtests):
        tools = self.place / "slow tools"
        tools.mkdir()
        (tools / "ffmpeg").write_text("#!/bin/sh\nexec sleep 1000\n")  # reads nothing, so the film stays unfinished
        (tools / "ffmpeg").chmod(stat.S_IRWXU)
        for number in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP):
            with (
                tempfile.TemporaryDirectory() as folder,
                subtests.test(number=number),
                subprocess.Popen(
                    [BINARY, "render", self.log, "--to", f"{folder}/film.webm"],
                    stderr=subprocess.PIPE,
                    env=os.environ | {"PATH": f"{tools}:{os.environ['PATH']}"},
                ) as process,
            ):
                until = time.monotonic() + PATIENCE
                while not os.listdir(folder) and time.monotonic() < until:
                    time.sleep(0.005)
                assert len(os.listdir(folder)) == 1
                process.send_signal(number)
                assert (process.wait(PATIENCE), process.stderr.read()) == (-number, b"")
                assert os.listdir(folder) == []

    @pytest.mark.needs_programs("ffmpeg")
    def test_a_film_of_the_real_ffmpeg_plays(self):
        assert self.render("real.webm")[0] == 0
        assert (self.place / "real.webm").read_bytes()[:4] == b"\x1aE\xdf\xa3"

    def test_an_episode_that_has_another_score_here_is_not_filmed(self):
        image = pathlib.Path(SOURCE, "games/homebrew/beamfall.bin").read_bytes()
        rules = pathlib.Path(SOURCE, "games/catalogue/beamfall.toml").read_text()
        other = self.place / "beamfall.toml"
        listed = f'[[image]]\nmd5 = "{hashlib.md5(image).hexdigest()}"\n\n[rule]'
        other.write_text(rules.replace("[rule]", listed).replace("bcd(0x84, 0x83, 0x82)", "lives * 1000"))
        status, output, errors = self.render("other.gif", None, "--game-file", other)
        assert (status, output) == (1, "")
        scores = re.search(r"^racebeam: the log has the score (\d+), but the machine gives (-?\d+), or ", errors)
        assert scores[1] != scores[2]
        assert not [path.name for path in self.place.iterdir() if "other" in path.name]

    def test_what_cannot_be_made_is_refused_and_leaves_nothing(self):
        (self.place / "there.gif").write_text("mine")
        broken = self.place / "broken.episode"
        data = bytearray(self.log.read_bytes())
        data[-1] ^= 1
        broken.write_bytes(data)
        for to, log, status, hint in (
            ("there.gif", None, 1, "exists; no file is replaced"),
            ("x.avi", None, 2, "accepted: .gif"),
            ("x.png", None, 2, "none for a folder of PNGs"),
            (".gif", None, 2, ".gif' is only an extension; accepted: names such as a.gif"),
            ("x.gif", broken, 1, "broken.episode"),
            ("x.gif", self.place / "nothing", 1, "nothing"),
            ("no/x.gif", None, 1, f"cannot make {self.place}/no/x.gif: the folder does not exist: {self.place}/no"),
        ):
            found, output, errors = self.render(to, log)
            assert (found, output, len(errors.splitlines())) == (status, "", 1), (to, errors)
            assert hint in errors
        done = subprocess.run(
            [BINARY, "render", self.log, "--to", ""], capture_output=True, text=True, timeout=PATIENCE
        )
        assert done.returncode == 2, done
        assert "--to: '' names no file" in done.stderr
        assert (self.place / "there.gif").read_text() == "mine"
        assert not (self.place / "x.gif").exists()
