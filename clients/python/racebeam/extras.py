"""The packages that parts of racebeam need, and that its installation brings only as extras."""

from __future__ import annotations

import sys

__all__ = ["REQUIREMENTS", "install_hint"]

REQUIREMENTS = {
    "dm_env": "dm-env>=1.6",
    "gymnasium": "gymnasium>=1.1" if sys.version_info >= (3, 11) else "gymnasium>=1.1,<1.4",
    "jax": "jax>=0.5",
    "pygame": "pygame>=2.1.3",
    "racebeam_evaluation": "./evaluation",
    "stable_baselines3": "stable-baselines3>=2.4",
    "submitit": "submitit>=1.5",
}


def install_hint(module: str) -> str:
    """Returns the end of an error message, which tells how a missing package is installed.

    The command names the package and not an extra of racebeam, since no index has racebeam. A path is that of a folder
    in racebeam's source.

    Args:
        module: Name of the module that cannot be imported.

    Returns:
        A text such as 'install it with: pip install "gymnasium>=1.1"'.
    """
    return f'install it with: pip install "{REQUIREMENTS[module]}"'
