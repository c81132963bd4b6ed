"""The interface of the machines that play the environments of AtariVectorEnv."""

from __future__ import annotations

from typing import Protocol

import numpy as np
import numpy.typing as npt

from .. import _core
from .results import Bools, Numbers, Pixels, Results

__all__ = ["Actions", "Joysticks", "Machines", "Seeds"]

Actions = npt.NDArray[np.int64]  # an index into the action set for each machine
Joysticks = npt.NDArray[np.float32]  # radius, angle and fire for each machine
Seeds = npt.NDArray[np.int64]  # a seed for each machine; -1 means unseeded


class Machines(Protocol):
    """Plays the environments of an `AtariVectorEnv`.

    `_core.VectorMachines` plays them in this process, `RemoteMachines` on a server, and `SpreadMachines` on several
    servers. Calls fill the arrays of a `Results`.
    """

    def step(self, actions: Actions, results: Results) -> None:
        """Steps all machines."""

    def step_joysticks(self, joysticks: Joysticks, threshold: float, results: Results) -> None:
        """Steps all machines with continuous actions."""

    def send(self, actions: Actions, machines: Numbers) -> None:
        """Begins a step of these machines."""

    def send_joysticks(self, joysticks: Joysticks, threshold: float, machines: Numbers) -> None:
        """Begins a step of these machines with continuous actions."""

    def send_strengths(self, actions: Actions, strengths: npt.NDArray[np.float32], machines: Numbers) -> None:
        """Begins a step of these machines with the strengths of their paddles, 0 to 1."""

    def send_resets(self, seeds: Seeds | None) -> None:
        """Begins a reset of all machines."""

    def receive(self, results: Results) -> None:
        """Waits for as many machines as `results` has columns."""

    def reset(self, reset_mask: Bools | None, seeds: Seeds | None, results: Results) -> None:
        """Resets the machines that `reset_mask` selects; all if it is None."""

    def show(self, results: Results) -> None:
        """Reads what all machines show, without stepping them."""

    def playing(self) -> int:
        """Returns how many machines were sent and not yet received."""

    def save(self, machine: int, include_rng: bool) -> _core.SavedMachine:
        """Returns the state of a machine."""

    def restore(self, machine: int, state: _core.SavedMachine) -> None:
        """Restores the state of a machine."""

    def screen(self, machine: int) -> Pixels:
        """Returns the screen of a machine, uint8 of shape (height, 160, 3)."""

    def numbers_of_actions(self) -> list[int]:
        """Returns the size of the action set of each machine."""

    def actions_of(self, machine: int) -> list[int]:
        """Returns the action set of a machine, as numbers of `Action`."""

    def image_warnings(self) -> list[str]:
        """Returns a warning for each image that the rule of another image scores."""

    def height(self) -> int:
        """Returns the rows of the screens."""
