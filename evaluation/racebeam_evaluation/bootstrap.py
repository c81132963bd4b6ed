"""Statistics of rliable, with intervals of a stratified bootstrap over trials.

R. Agarwal et al.: "Deep Reinforcement Learning at the Edge of the Statistical Precipice", NeurIPS 2021. A matrix of scores
has a row for each trial and a column for each game. rliable 1.2.0 ignores its argument `random_state` and draws from NumPy's
global generator, so each interval seeds that one, and puts it back afterwards."""

import contextlib
import dataclasses
from collections.abc import Callable, Iterator

import numpy as np
import numpy.typing as npt
from rliable import library, metrics

Matrix = npt.NDArray[np.float64]

FEWEST_TRIALS = 2  # for an interval and for a test


@dataclasses.dataclass(frozen=True)
class Estimate:
    """Values with the bounds of their intervals. A bound is NaN if there are too few trials."""

    value: Matrix
    low: Matrix
    high: Matrix


@dataclasses.dataclass(frozen=True)
class Bootstrap:
    """How intervals are made."""

    seed: int = 1
    repetitions: int = 2000
    confidence: float = 0.95

    def estimate(self, function: Callable[..., Matrix], *matrices: Matrix) -> Estimate:
        """function(*matrices), a vector. Trials are drawn anew for each game and each matrix."""
        if min(len(matrix) for matrix in matrices) < FEWEST_TRIALS:
            value = function(*matrices)
            return Estimate(value, np.full_like(value, np.nan), np.full_like(value, np.nan))
        scores = {"": matrices[0] if len(matrices) == 1 else list(matrices)}
        with _seeded(self.seed):
            values, bounds = library.get_interval_estimates(
                scores, function, reps=self.repetitions, confidence_interval_size=self.confidence)
        return Estimate(values[""], bounds[""][0], bounds[""][1])


@contextlib.contextmanager
def _seeded(seed: int) -> Iterator[None]:
    before = np.random.get_state()
    np.random.seed(seed)
    try:
        yield
    finally:
        np.random.set_state(before)


def aggregates(scores: Matrix) -> Matrix:
    """Interquartile mean, and optimality gap to 1."""
    return np.array([metrics.aggregate_iqm(scores), metrics.aggregate_optimality_gap(scores)])


def profile(thresholds: Matrix) -> Callable[[Matrix], Matrix]:
    """The performance profile: the share of scores above each threshold."""
    def shares(scores: Matrix) -> Matrix:
        return np.array((scores[..., np.newaxis] > thresholds).mean(axis=(0, 1)))
    return shares


def improvement(first: Matrix, second: Matrix) -> Matrix:
    """The probability that a trial of the first scores more than one of the second, the mean over games; ties count half.

    The same as rliable's probability_of_improvement, without its p-values, which take most of its time."""
    signs = np.sign(first[:, np.newaxis, :] - second[np.newaxis, :, :])
    return np.array([(signs.mean() + 1) / 2])
