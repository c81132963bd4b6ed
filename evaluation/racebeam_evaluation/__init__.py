"""Tables, tests and figures from the results of `racebeam experiment` (docs/evaluation.md)."""

from .errors import BadInput
from .load import Frames, load

__all__ = ["BadInput", "Frames", "load"]
