"""Results of `racebeam experiment` as pandas frames, read by the package racebeam-evaluation.

    from racebeam.results import load
    load("results").scores

Importing this module needs that package, which is the folder evaluation of racebeam's source.
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
