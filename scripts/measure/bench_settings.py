"""The settings and the actions of measurements."""

import random
from dataclasses import dataclass

import cartridges


@dataclass(frozen=True)
class Setting:
    heading: str
    skip: int  # frames of an act
    look: bool  # observe the screen after each act

    def command(self, binary, game, cpu=None):
        """The words that start `racebeam bench --commands` (cli/bench/bench_session.hpp). cpu: None for the default.

        Raises LookupError if the image of the game is missing."""
        words = [str(binary), "bench", "--commands", "--rom", cartridges.image(game), "--frame-skip", str(self.skip)]
        return [*words, "--screen", "last" if self.look else "none", *(["--cpu", cpu] if cpu else [])]


SETTINGS = {
    "every": Setting("Screen of every frame", 1, True),
    "last": Setting("Frame skip 4, screen of the last", 4, True),
    "none": Setting("Rewards and RAM only", 1, False),
}


def draw_actions(game, legal_actions, count):
    """Draws actions like a player's: each is held for four acts on average. A game's are the same each time."""
    generator, actions, action = random.Random(game), [], 0
    for _ in range(count):
        if generator.random() < 0.25:
            action = legal_actions[int(generator.random() * len(legal_actions))]
        actions.append(action)
    return actions
