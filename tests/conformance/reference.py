"""Runs ALE in this process through ale-py, as a black box. The output has the format of `racebeam trace`."""

import zlib

import ale_py
import numpy
from run import action_word

VERSION = ale_py.__version__


class Reference:
    def __init__(self, run, image):
        ale_py.ALEInterface.setLoggerMode(ale_py.LoggerMode.Error)
        self.run, self.ale = run, ale_py.ALEInterface()
        self.configure()
        self.ale.loadROM(image.path)
        if run.mode is not None:
            self.ale.setMode(run.mode)
        if run.difficulty is not None:
            self.ale.setDifficulty(run.difficulty)
        if run.mode is not None or run.difficulty is not None:
            self.ale.reset_game()
        height, width = self.ale.getScreenDims()
        self.screen, self.grey, self.rgb = (
            numpy.zeros(shape, numpy.uint8) for shape in ((height, width), (height, width), (height, width, 3))
        )
        self.ram, self.audio = numpy.zeros(128, numpy.uint8), numpy.zeros(512, numpy.uint8)
        self.line = self.frames = 0
        self.episode, self.act_of_episode = 1, 0

    def configure(self):
        run, ale = self.run, self.ale
        ale.setInt("random_seed", run.generator_seed)
        ale.setInt("frame_skip", run.skip)
        ale.setInt("max_num_frames_per_episode", run.limit)
        ale.setFloat("repeat_action_probability", run.sticky)
        ale.setBool("color_averaging", bool(run.averaging))
        ale.setBool("truncate_on_loss_of_life", bool(run.lifeloss))
        ale.setBool("sound_obs", True)

    def lists(self):
        """The lists of the game, as `racebeam games --json` prints them."""

        def names(actions):
            return [action.name for action in actions]

        return {
            "modes": sorted(self.ale.getAvailableModes()),
            "difficulties": sorted(self.ale.getAvailableDifficulties()),
            "legal_actions": names(self.ale.getLegalActionSet()),
            "minimal_actions": names(self.ale.getMinimalActionSet()),
        }

    def lines(self, steps):
        """Yields the lines, and where each step is. A step is played when its line is requested."""
        yield "R" + self.observation()
        for kind, first, second in steps:
            if kind == "M":
                self.ale.setRAM(first, second)
                yield f"M {first} {second}" + self.observation()
                continue
            yield self.act(first, second)
            if self.ale.game_over():
                self.ale.reset_game()
                self.episode, self.act_of_episode = self.episode + 1, 0
                yield "R" + self.observation()

    def act(self, action, strength):
        ale = self.ale
        self.act_of_episode += 1
        before = ale.getFrameNumber()
        reward = int(ale.act(action, strength))
        self.frames += ale.getFrameNumber() - before
        return f"A {action_word(action, strength)} {reward} {ale.game_over():d}{self.observation()}"

    def observation(self):
        ale, crc = self.ale, zlib.crc32
        ale.getRAM(self.ram)
        ale.getScreen(self.screen)
        ale.getAudio(self.audio)
        colors = "- -" if self.line % self.run.colors_every else self.colors()
        self.line += 1
        return (
            f" {ale.lives()} {crc(self.ram):08x} {crc(self.screen):08x} {crc(self.audio):08x} "
            f"{ale.game_truncated():d} {ale.getFrameNumber()} {ale.getEpisodeFrameNumber()} {colors}"
        )

    def colors(self):
        self.ale.getScreenRGB(self.rgb)
        self.ale.getScreenGrayscale(self.grey)
        return f"{zlib.crc32(self.rgb):08x} {zlib.crc32(self.grey):08x}"
