"""Student's t: quantiles, intervals of means, and Welch's test of two samples."""

import math
import statistics

CONFIDENCE = 0.95
STEPS = 200  # of a continued fraction, and of a bisection


def two_tailed(t, freedom):
    """The probability that a value of Student's t is at least so far from 0."""
    return incomplete_beta(freedom / 2, 0.5, freedom / (freedom + t * t))


def quantile(freedom, confidence=CONFIDENCE):
    """How far to each side of 0 a value of Student's t is with this probability."""
    low, high = 0.0, 1.0
    while two_tailed(high, freedom) > 1 - confidence:
        high *= 2
    for _ in range(STEPS):
        middle = (low + high) / 2
        low, high = (middle, high) if two_tailed(middle, freedom) > 1 - confidence else (low, middle)
    return high


def incomplete_beta(a, b, x):
    """The regularised incomplete beta function, by its continued fraction."""
    if x > (a + 1) / (a + b + 2):
        return 1 - incomplete_beta(b, a, 1 - x)
    if x == 0:
        return 0.0
    factor = math.exp(
        math.lgamma(a + b) - math.lgamma(a) - math.lgamma(b) + a * math.log(x) + b * math.log1p(-x) - math.log(a)
    )
    fraction = 1.0
    for step in range(STEPS, 0, -1):
        half = step // 2
        if step % 2:
            term = -(a + half) * (a + b + half) * x / ((a + 2 * half) * (a + 2 * half + 1))
        else:
            term = half * (b - half) * x / ((a + 2 * half - 1) * (a + 2 * half))
        fraction = 1 + term / fraction
    return factor / fraction


def bounds(sample):
    """The 95 % interval of a mean; None of a single score."""
    if len(sample) < 2:
        return None
    half = quantile(len(sample) - 1) * statistics.stdev(sample) / len(sample) ** 0.5
    mean = statistics.mean(sample)
    return mean - half, mean + half


def welch(first, second):
    """The difference of the means of two samples, its 95 % interval, and the p-value of Welch's t-test. At least one
    sample varies."""
    parts = [statistics.variance(sample) / len(sample) for sample in (first, second)]
    squares = sum(part * part / (len(sample) - 1) for part, sample in zip(parts, (first, second)))
    freedom, error = sum(parts) ** 2 / squares, math.sqrt(sum(parts))
    difference = statistics.mean(first) - statistics.mean(second)
    half = quantile(freedom) * error
    return difference, (difference - half, difference + half), two_tailed(difference / error, freedom)
