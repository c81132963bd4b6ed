"""One run: a game, settings of the server, and the client's lines.

A run's name contains everything that determines it: `pong:seed=7,skip=4,lines=500` is the same run on every
machine. Settings that it does not name have their defaults.
"""

import pathlib
import random
import sys
from dataclasses import dataclass

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from named_run import NamedRun  # noqa: E402

SKIPS, STICKIES = (1, 1, 2, 4, 5), (0.0, 0.25, 0.25, 0.5)
HOLD = 0.75  # the probability that the players hold their actions for another line
PLAYER_B = 18  # player B's first action, which is to do nothing
SAVE, LOAD, RESET, NOTHING = 43, 44, 45, 40
SPECIALS = (SAVE, SAVE, LOAD, LOAD, NOTHING)
DEEPEST = 8  # saved states at once
FLAGS = "1,1,0,1"  # screen, RAM, nothing, episode


@dataclass(frozen=True)
class Run(NamedRun):
    ALWAYS = ("seed", "lines")

    game: str
    skip: int = 1
    sticky: float = 0.25
    averaging: int = 0
    full: int = 0  # screens without run lengths
    limit: int = 0  # frames of an episode
    frames: int = 0  # of the session
    both: int = 0  # player B plays too
    specials: int = 0  # of 1,000 lines: saves, loads, "nothing" as 40
    resets: int = 0  # of 1,000 lines
    seed: int = 1
    lines: int = 500

    def options(self):
        """The server's command line, without the image."""
        values = {
            "game_controller": "fifo",
            "random_seed": self.seed,
            "frame_skip": self.skip,
            "repeat_action_probability": self.sticky,
            "color_averaging": truth(self.averaging),
            "run_length_encoding": truth(not self.full),
            "max_num_frames_per_episode": self.limit,
            "max_num_frames": self.frames,
        }
        return [word for key, value in values.items() for word in (f"-{key}", str(value))]

    def requests(self):
        """The client's lines: the flags, then actions."""
        generator, pressed, depth = random.Random(f"classic {self.name}"), (0, PLAYER_B), 0
        yield FLAGS
        for _ in range(self.lines):
            special = self.special(generator, depth)
            depth += {SAVE: 1, LOAD: -1}.get(special, 0)
            if generator.random() >= HOLD:
                pressed = generator.randrange(18), PLAYER_B + (generator.randrange(18) if self.both else 0)
            yield f"{pressed[0] if special is None else special},{pressed[1]}"

    def special(self, generator, depth):
        """The client's request in place of an action; None: an action."""
        if generator.randrange(1000) < self.resets:
            return RESET
        if generator.randrange(1000) >= self.specials:
            return None
        special = generator.choice(SPECIALS)
        impossible = special == LOAD and depth == 0 or special == SAVE and depth == DEEPEST
        return NOTHING if impossible else special


def truth(value):
    return "true" if value else "false"


def random_run(game, seed, lines):
    """A run of the game, with settings that are drawn from the seed."""
    generator = random.Random(f"settings {game} {seed}")
    return Run(
        game,
        skip=generator.choice(SKIPS),
        sticky=generator.choice(STICKIES),
        averaging=generator.randrange(2),
        full=int(generator.random() < 0.2),
        limit=generator.choice((0, 0, generator.randrange(60, 1200))),
        frames=generator.choice((0, 0, 0, generator.randrange(300, 2000))),
        both=generator.randrange(2),
        specials=generator.choice((0, 20, 100)),
        resets=generator.choice((0, 2, 10)),
        seed=generator.randrange(1, 1 << 31),
        lines=lines,
    )
