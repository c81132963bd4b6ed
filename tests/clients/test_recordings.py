"""Recordings show what was played: they are read back by Pillow, and by hand."""

import glob
import os
import sys

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path[:0] = [
    os.path.join(SOURCE, folder) for folder in ("tests/server", "tests/support", "clients/python/single_file")
]

import pytest  # noqa: E402

pytest.importorskip("numpy")
pytest.importorskip("PIL")

import wave  # noqa: E402

import client as racebeam  # noqa: E402
import numpy as np  # noqa: E402
from harness import BINARY  # noqa: E402
from PIL import Image, ImageSequence  # noqa: E402

FRAMES = 60


class TestRecordings:
    @pytest.fixture(autouse=True)
    def set_up(self, tmp_path):
        self.folder = tmp_path
        self.session = racebeam.Session.start(BINARY, "--record-dir", str(tmp_path))
        self.session.load("beamfall", seed=1, sticky=0, sound=1)
        self.session.observe("rgb", "audio")
        yield
        self.session.close_connection()

    def play(self, kind, name="a"):
        """Records. Returns the path, and for each frame the doubled picture and the sound."""
        self.session.record(kind, name)
        results = [self.session.act(frame // 5 % 18) for frame in range(FRAMES)]
        path = os.path.join(self.folder, self.session.stop_recording()["recorded"])
        pictures = [np.frombuffer(one["rgb"], np.uint8).reshape(210, 160, 3).repeat(2, axis=1) for one in results]
        return path, pictures, [one["audio"] for one in results]

    def test_png(self):
        path, pictures, _ = self.play("png")
        files = sorted(glob.glob(path + "/*.png"))
        assert len(files) == FRAMES
        for file, picture in zip(files, pictures):
            np.testing.assert_array_equal(np.asarray(Image.open(file).convert("RGB")), picture)

    def test_gif(self):
        path, pictures, _ = self.play("gif")
        with Image.open(path) as gif:
            frames = [np.asarray(frame.convert("RGB")) for frame in ImageSequence.Iterator(gif)]
            seconds = sum(frame.info["duration"] for frame in ImageSequence.Iterator(gif)) / 1000
        assert (len(frames), seconds) == (FRAMES // 2, 1)
        for frame, picture in zip(frames, pictures[::2]):
            np.testing.assert_array_equal(frame, picture)

    def test_y4m(self):
        path, pictures, _ = self.play("y4m")
        with open(path, "rb") as file:
            assert file.readline() == b"YUV4MPEG2 W320 H210 F60:1 Ip A1:1 C444\n"
            for picture in pictures:
                assert file.readline() == b"FRAME\n"
                y, u, v = np.frombuffer(file.read(3 * 320 * 210), np.uint8).reshape(3, 210, 320).astype(float)
                y, u, v = 1.164384 * (y - 16), u - 128, v - 128
                rgb = np.stack([y + 1.596027 * v, y - 0.391762 * u - 0.812968 * v, y + 2.017232 * u], axis=-1)
                assert np.abs(rgb - picture).max() < 3
            assert file.read() == b""

    def test_wav(self):
        path, _, sound = self.play("wav")
        with wave.open(path) as file:
            assert (file.getframerate(), file.getnchannels(), file.getsampwidth()) == (60 * 512, 1, 1)
            assert file.getnframes() == FRAMES * 512
            assert len(set(file.readframes(FRAMES * 512))) > 1

    def test_every_frame_of_an_act_is_recorded(self):
        self.session.observe("rgb")
        self.session.load("beamfall", seed=1, frame_skip=4)
        self.session.record("png", "b")
        self.session.act("UP*3")
        assert self.session.stop_recording()["frames"] == 12
