"""Recordings show what was played: they are read back by Pillow, and by hand."""

import glob
import os
import sys
import tempfile

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path[:0] = [
    os.path.join(SOURCE, folder) for folder in ("tests/server", "tests/support", "clients/python/single_file")
]

import pytest  # noqa: E402

pytest.importorskip("numpy")
pytest.importorskip("PIL")

import unittest  # noqa: E402
import wave  # noqa: E402

import client as racebeam  # noqa: E402
import numpy as np  # noqa: E402
from harness import BINARY, main  # noqa: E402
from PIL import Image, ImageSequence  # noqa: E402

FRAMES = 60


class Recordings(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.session = racebeam.Session.start(BINARY, "--record-dir", self.folder.name)
        self.session.load("beamfall", seed=1, sticky=0, sound=1)
        self.session.observe("rgb", "audio")

    def tearDown(self):
        self.session.close_connection()
        self.folder.cleanup()

    def play(self, kind, name="a"):
        """Records. Returns the path, and for each frame the doubled picture and the sound."""
        self.session.record(kind, name)
        results = [self.session.act(frame // 5 % 18) for frame in range(FRAMES)]
        path = os.path.join(self.folder.name, self.session.stop_recording()["recorded"])
        pictures = [np.frombuffer(one["rgb"], np.uint8).reshape(210, 160, 3).repeat(2, axis=1) for one in results]
        return path, pictures, [one["audio"] for one in results]

    def test_png(self):
        path, pictures, _ = self.play("png")
        files = sorted(glob.glob(path + "/*.png"))
        self.assertEqual(len(files), FRAMES)
        for file, picture in zip(files, pictures):
            np.testing.assert_array_equal(np.asarray(Image.open(file).convert("RGB")), picture)

    def test_gif(self):
        path, pictures, _ = self.play("gif")
        with Image.open(path) as gif:
            frames = [np.asarray(frame.convert("RGB")) for frame in ImageSequence.Iterator(gif)]
            seconds = sum(frame.info["duration"] for frame in ImageSequence.Iterator(gif)) / 1000
        self.assertEqual((len(frames), seconds), (FRAMES // 2, 1))
        for frame, picture in zip(frames, pictures[::2]):
            np.testing.assert_array_equal(frame, picture)

    def test_y4m(self):
        path, pictures, _ = self.play("y4m")
        with open(path, "rb") as file:
            self.assertEqual(file.readline(), b"YUV4MPEG2 W320 H210 F60:1 Ip A1:1 C444\n")
            for picture in pictures:
                self.assertEqual(file.readline(), b"FRAME\n")
                y, u, v = np.frombuffer(file.read(3 * 320 * 210), np.uint8).reshape(3, 210, 320).astype(float)
                y, u, v = 1.164384 * (y - 16), u - 128, v - 128
                rgb = np.stack([y + 1.596027 * v, y - 0.391762 * u - 0.812968 * v, y + 2.017232 * u], axis=-1)
                self.assertLess(np.abs(rgb - picture).max(), 3)
            self.assertEqual(file.read(), b"")

    def test_wav(self):
        path, _, sound = self.play("wav")
        with wave.open(path) as file:
            self.assertEqual((file.getframerate(), file.getnchannels(), file.getsampwidth()), (60 * 512, 1, 1))
            self.assertEqual(file.getnframes(), FRAMES * 512)
            self.assertGreater(len(set(file.readframes(FRAMES * 512))), 1)

    def test_every_frame_of_an_act_is_recorded(self):
        self.session.observe("rgb")
        self.session.load("beamfall", seed=1, frame_skip=4)
        self.session.record("png", "b")
        self.session.act("UP*3")
        self.assertEqual(self.session.stop_recording()["frames"], 12)


if __name__ == "__main__":
    main()
