"""Statistics of rliable, with intervals of a stratified bootstrap over trials.

R. Agarwal et al.: "Deep Reinforcement Learning at the Edge of the Statistical Precipice", NeurIPS 2021. A matrix of
scores has a row for each trial and a column for each game. Where games have different numbers of trials, NaN fill the
columns, and each game counts the same: the statistics are rliable's with trials that have weights. rliable 1.2.0
ignores its argument `random_state` and draws from NumPy's global generator, so each interval seeds that one, and puts
it back afterwards."""

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
        if min(int(trials_of(matrix).min()) for matrix in matrices) < FEWEST_TRIALS:
            value = function(*matrices)
            return Estimate(value, np.full_like(value, np.nan), np.full_like(value, np.nan))
        if any(map(_is_ragged, matrices)):
            return self._of_ragged(function, matrices)
        scores = {"": matrices[0] if len(matrices) == 1 else list(matrices)}
        with _seeded(self.seed):
            values, bounds = library.get_interval_estimates(
                scores, function, reps=self.repetitions, confidence_interval_size=self.confidence
            )
        return Estimate(values[""], bounds[""][0], bounds[""][1])

    def _of_ragged(self, function: Callable[..., Matrix], matrices: tuple[Matrix, ...]) -> Estimate:
        """A percentile bootstrap like rliable's, of matrices that rliable does not take."""
        generator = np.random.default_rng(self.seed)
        estimates = [function(*(_resample(matrix, generator) for matrix in matrices)) for _ in range(self.repetitions)]
        tail = 50 * (1 - self.confidence)
        low, high = np.percentile(estimates, [tail, 100 - tail], axis=0)
        return Estimate(function(*matrices), low, high)


@contextlib.contextmanager
def _seeded(seed: int) -> Iterator[None]:
    before = np.random.get_state()
    np.random.seed(seed)
    try:
        yield
    finally:
        np.random.set_state(before)


def padded(columns: list[npt.NDArray[np.float64]]) -> Matrix:
    """The matrix with these columns, which are filled with NaN."""
    matrix = np.full((max(map(len, columns)), len(columns)), np.nan)
    for game, trials in enumerate(columns):
        matrix[: len(trials), game] = trials
    return matrix


def trials_of(scores: Matrix) -> npt.NDArray[np.int64]:
    """The number of trials of each game. They are in the first rows."""
    return np.asarray((~np.isnan(scores)).sum(axis=0))


def _is_ragged(scores: Matrix) -> bool:
    return bool(np.isnan(scores).any())


def _resample(scores: Matrix, generator: np.random.Generator) -> Matrix:
    """Draws as many trials of each game anew."""
    rows = (generator.random(scores.shape) * trials_of(scores)).astype(int)
    return np.where(np.isnan(scores), np.nan, np.take_along_axis(scores, rows, axis=0))


def _mean(values: Matrix) -> Matrix:
    """The mean over games of the means over trials, the first two axes."""
    return np.asarray(np.nanmean(values, axis=0).mean(axis=0))


def _interquartile_mean(scores: Matrix) -> float:
    """The mean without the lowest and the highest quarter of the weight. A game has the weight 1, which its trials
    share."""
    weights = np.broadcast_to(1 / trials_of(scores), scores.shape)[~np.isnan(scores)]
    values = scores[~np.isnan(scores)]
    order = np.argsort(values, kind="stable")
    ends = np.cumsum(weights[order])
    low, high = ends[-1] / 4, ends[-1] * 3 / 4
    inside = np.clip(np.minimum(ends, high) - np.maximum(ends - weights[order], low), 0, None)
    return float((inside * values[order]).sum() / inside.sum())


AGGREGATES = ("average", "median", "IQM", "optimality gap")


def aggregates(scores: Matrix) -> Matrix:
    """AGGREGATES: mean and median over games of the means of trials, interquartile mean, optimality gap to 1."""
    of_games = np.nanmean(scores, axis=0)
    if _is_ragged(scores):
        rest = [_interquartile_mean(scores), 1 - _mean(np.minimum(scores, 1))]
    else:
        rest = [metrics.aggregate_iqm(scores), metrics.aggregate_optimality_gap(scores)]
    return np.array([of_games.mean(), np.median(of_games), *rest])


def profile(thresholds: Matrix) -> Callable[[Matrix], Matrix]:
    """The performance profile: the share of scores above each threshold."""

    def shares(scores: Matrix) -> Matrix:
        if _is_ragged(scores):
            above = scores[..., np.newaxis] > thresholds
            return _mean(np.where(np.isnan(scores)[..., np.newaxis], np.nan, above))
        return np.array((scores[..., np.newaxis] > thresholds).mean(axis=(0, 1)))

    return shares


def improvement(first: Matrix, second: Matrix) -> Matrix:
    """The probability that a trial of the first scores more than one of the second, the mean over games; ties count
    half.

    The same as rliable's probability_of_improvement, without its p-values, which take most of its time."""
    signs = np.sign(first[:, np.newaxis, :] - second[np.newaxis, :, :])
    if np.isnan(signs).any():
        return np.array([(_mean(signs.reshape(-1, signs.shape[-1])) + 1) / 2])
    return np.array([(signs.mean() + 1) / 2])
