"""Results of `racebeam experiment` as pandas frames, read by the package racebeam-evaluation.

    from racebeam.results import load
    load("results").scores

That package is in racebeam's source, and importing this module needs it: pip install ./evaluation.
"""

from __future__ import annotations

from .extras import install_hint

try:
    from racebeam_evaluation import BadInput, Frames, load  # type: ignore[import-not-found,unused-ignore]
except ModuleNotFoundError as error:
    if error.name != "racebeam_evaluation":
        raise
    raise ImportError(f"racebeam.results needs racebeam-evaluation; {install_hint(error.name)}") from error

__all__ = ["BadInput", "Frames", "load"]
