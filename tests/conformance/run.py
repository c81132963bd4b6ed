"""One run of the suite: a game, its settings, a seed and a number of frames; and its actions.

A run's name contains everything that determines it: `pong:skip=4,sticky=0.25,averaging=1,seed=7,frames=2000`
is the same run on every machine. Settings that it does not name have their defaults.
"""

import pathlib
import random
import sys
from dataclasses import dataclass

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from named_run import NamedRun  # noqa: E402

HOLD = 0.75  # the probability that an action is held for another act
WRITE = 0.01  # the probability of a RAM write before an act, in runs with writes
COLORS_EVERY = 16  # acts; without averaging, the palette indices of a screen say all


@dataclass(frozen=True)
class Run(NamedRun):
    ALWAYS = ("seed", "frames")

    game: str
    mode: int | None = None
    difficulty: int | None = None
    skip: int = 1
    sticky: float = 0.0
    averaging: int = 0
    writes: int = 0  # bytes of RAM are written at random moments
    limit: int = 0  # frames of an episode
    lifeloss: int = 0  # an episode is truncated when a life is lost
    strengths: int = 0  # paddles turn by random strengths
    seed: int = 1
    frames: int = 2000

    @property
    def setting(self):
        """The cell of the table of settings to which the run belongs."""
        return self.mode, self.difficulty, self.skip, self.sticky, self.averaging

    @property
    def acts(self):
        return -(-self.frames // self.skip)

    @property
    def colors_every(self):
        return 1 if self.averaging else COLORS_EVERY

    @property
    def generator_seed(self):
        """The seed of sticky actions; never 0, which may mean "from the clock"."""
        return random.Random(f"generator {self.name}").randrange(1, 1 << 31)

    def steps(self):
        """The steps: ("A", action, strength) and ("M", index, value)."""
        generator, action = random.Random(f"steps {self.name}"), 0
        for _ in range(self.acts):
            if self.writes and generator.random() < WRITE:
                yield "M", generator.randrange(128), generator.randrange(256)
            if generator.random() >= HOLD:
                action = generator.randrange(18)
            yield "A", action, generator.randrange(-64, 129) / 64 if self.strengths else 1


def action_word(action, strength):
    return f"{action}" if strength == 1 else f"{action}@{strength:.9g}"


def step_word(step):
    """A step in the format of `racebeam trace`."""
    kind, first, second = step
    return f"M {first} {second}" if kind == "M" else action_word(first, second)
