"""The runs of the suite."""

import itertools
import random

import ours
from images import rule_of
from not_comparable import comparable
from run import Run

SKIPS, STICKIES, AVERAGINGS = (1, 4), (0, 0.25), (0, 1)
# In settings other than the default: what else is tried, and in how many of 100 runs.
EXTRAS = (("writes", 25), ("limit", 25), ("lifeloss", 12), ("strengths", 50))


def variants(game):
    """(mode, difficulty): the default, each other mode, each other difficulty. None is the default."""
    rule = ours.catalogue()[rule_of(game)]
    modes = [mode for mode in rule["modes"] if mode != rule["default_mode"]]
    difficulties = [difficulty for difficulty in rule["difficulties"] if difficulty != 0]
    return [(None, None), *((mode, None) for mode in modes), *((None, difficulty) for difficulty in difficulties)]


def with_extras(run):
    """The run, with random extras."""
    generator, values = random.Random(f"extras {run.name}"), {}
    for key, percent in EXTRAS:
        if generator.randrange(100) < percent:
            values[key] = generator.randrange(60, 1200) if key == "limit" else 1
    return Run(**{**vars(run), **values})


def other_runs(game, seed, frames):
    """One run in each setting except the default one."""
    for (mode, difficulty), skip, sticky, averaging in itertools.product(variants(game), SKIPS, STICKIES, AVERAGINGS):
        if (mode, difficulty, skip, sticky, averaging) != (None, None, 1, 0, 0):
            yield with_extras(Run(game, mode, difficulty, skip, sticky, averaging, seed=seed, frames=frames))


def plan(games, settings, seeds, frames, other_frames):
    """The runs, long ones first, and (name of a run, gap) for everything that was left out of one."""
    runs = [Run(game, seed=seed, frames=frames) for seed in seeds for game in games]
    for game in games:
        others = list(other_runs(game, seeds[0], other_frames))
        if settings == "all":
            runs += others
        elif settings == "sample":
            runs.append(random.Random(f"sample {game} {seeds[0]}").choice(others))
    pairs = [comparable(run) for run in runs]
    gaps = [(run.name, gap) for run, gaps in pairs for gap in gaps]
    return sorted((run for run, _ in pairs), key=lambda run: -run.acts), gaps
