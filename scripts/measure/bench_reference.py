"""The reference's side of a measurement: ALE, through ale-py, in its own process.

It accepts the same commands as `racebeam bench --commands`, with the same answers (cli/bench/bench_session.hpp), and
one more, which begins a measurement:

  open SKIP LOOK IMAGE    a new machine: frames of an act, 1 if the screen is observed, the image's file

The processor time of this process is measured. It includes the loop and the calls in Python: about 0.2
microseconds an act, and 0.4 for the copy of a screen, while a frame takes 40 to 130. (racebeam's screen is
read in place.)
"""

import json
import pathlib
import struct
import sys
import time
import zlib

import ale_py
import numpy

SEED = 123


class Reference:
    def __init__(self, skip, look, image):
        ale_py.ALEInterface.setLoggerMode(ale_py.LoggerMode.Error)
        self.ale = ale_py.ALEInterface()
        self.ale.setInt("frame_skip", skip)
        self.ale.setInt("random_seed", SEED)
        self.ale.setFloat("repeat_action_probability", 0.0)
        self.ale.loadROM(pathlib.Path(image))
        self.look = look
        self.screen = numpy.zeros(self.ale.getScreenDims(), numpy.uint8)
        self.ram = numpy.zeros(128, numpy.uint8)

    def play(self, actions):
        self.begin()
        act, over = self.ale.act, self.ale.game_over
        see, place = (self.ale.getScreen, self.screen) if self.look else (self.ale.getRAM, self.ram)
        reward, start = 0, time.process_time_ns()
        for action in actions:
            reward += act(action)
            see(place)
            if over():
                self.reset()
        seconds = (time.process_time_ns() - start) * 1e-9 - self.reset_seconds
        self.reward = int(reward)
        return self.tally() | {"seconds": seconds, "reset_seconds": self.reset_seconds} | self.sight(self.look)

    def check(self, actions):
        self.begin()
        digest = 0
        for action in actions:
            reward = int(self.ale.act(action))
            self.reward += reward
            digest = self.digest_of_act(digest, reward)
            if self.ale.game_over():
                self.reset()
        return self.tally() | {"digest": digest}

    def time_resets(self, times):
        self.begin()
        for _ in range(times):
            self.reset()
        return {"seconds": self.reset_seconds / times} | self.sight(True)

    def time_snapshots(self, times):
        save, restore = self.ale.cloneState, self.ale.restoreState
        start = time.process_time_ns()
        for _ in range(times):
            restore(save())
        return {"seconds": (time.process_time_ns() - start) * 1e-9 / times}

    def begin(self):
        self.frames = self.reward = self.resets = 0
        self.reset_seconds = 0.0
        self.first_frame = self.ale.getFrameNumber()

    def reset(self):
        start = time.process_time_ns()
        self.frames += self.ale.getFrameNumber() - self.first_frame
        self.ale.reset_game()
        self.first_frame = self.ale.getFrameNumber()
        self.resets += 1
        self.reset_seconds += (time.process_time_ns() - start) * 1e-9

    def tally(self):
        frames = self.frames + self.ale.getFrameNumber() - self.first_frame
        return {"frames": frames, "reward": self.reward, "resets": self.resets}

    def sight(self, screen):
        self.ale.getScreen(self.screen)
        self.ale.getRAM(self.ram)
        return ({"screen": zlib.crc32(self.screen)} if screen else {}) | {"ram": zlib.crc32(self.ram)}

    def digest_of_act(self, digest, reward):
        if self.look:
            self.ale.getScreen(self.screen)
            digest = zlib.crc32(self.screen, digest)
        self.ale.getRAM(self.ram)
        rest = struct.pack("<iBB", reward, self.ale.game_over(), self.ale.lives() & 255)
        return zlib.crc32(rest, zlib.crc32(self.ram, digest))


def main():
    reference = None
    for line in sys.stdin:
        command, _, words = line.strip().partition(" ")
        if command == "open":
            skip, look, image = words.split(" ", 2)
            reference = Reference(int(skip), look == "1", image)
            answer = {
                "version": ale_py.__version__,
                "legal_actions": [action.value for action in reference.ale.getLegalActionSet()],
            }
        elif command in ("play", "check"):
            answer = getattr(reference, command)([int(word) for word in words.split()])
        else:
            time_it = {"reset": reference.time_resets, "save": reference.time_snapshots}[command]
            answer = time_it(int(words))
        print(json.dumps(answer), flush=True)


if __name__ == "__main__":
    main()
