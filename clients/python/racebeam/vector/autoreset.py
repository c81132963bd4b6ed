"""The names of gymnasium.vector that differ between the versions of Gymnasium.

`AtariVectorEnv` needs Gymnasium 1.1. `racebeam.envpool` also runs on Gymnasium 0.29.1, which has no AutoresetMode, and
whose VectorEnv has another interface; there, stand-ins take their place.
"""

from __future__ import annotations

import enum
from typing import TYPE_CHECKING, Any, Generic, TypeVar

import gymnasium.vector

from ..extras import install_hint

__all__ = ["AutoresetMode", "IS_SUPPORTED", "VectorEnv"]

IS_SUPPORTED = hasattr(gymnasium.vector, "AutoresetMode")

if TYPE_CHECKING or IS_SUPPORTED:
    from gymnasium.vector import AutoresetMode, VectorEnv
else:

    class AutoresetMode(enum.Enum):
        """When an environment begins a new episode, as Gymnasium 1.1 defines it."""

        NEXT_STEP = "NextStep"
        SAME_STEP = "SameStep"
        DISABLED = "Disabled"

    Observation, Action, Array = TypeVar("Observation"), TypeVar("Action"), TypeVar("Array")

    class VectorEnv(gymnasium.vector.VectorEnv, Generic[Observation, Action, Array]):
        """A VectorEnv with the part of the interface of Gymnasium 1.1 that racebeam.envpool uses."""

        closed = False
        spec = None

        def close(self, **kwargs: Any) -> None:
            """Closes the environments. A second call does nothing."""
            if not self.closed:
                self.close_extras(**kwargs)
                self.closed = True


def check_supported(name: str) -> None:
    """Checks the version of Gymnasium.

    Args:
        name: Name of the class that needs Gymnasium 1.1.

    Raises:
        ImportError: If Gymnasium is older than 1.1.
    """
    if not IS_SUPPORTED:
        raise ImportError(
            f"{name} needs Gymnasium 1.1 or later, and this is {gymnasium.__version__}; {install_hint('gymnasium')}"
        )
