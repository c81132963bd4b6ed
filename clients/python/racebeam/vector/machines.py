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
        """Steps all machines.

        Args:
            actions: An index into the action set for each machine.
            results: Receives what the machines show.
        """

    def step_joysticks(self, joysticks: Joysticks, threshold: float, results: Results) -> None:
        """Steps all machines with continuous actions.

        Args:
            joysticks: Radius, angle and fire for each machine.
            threshold: Deflection from which a direction or the button counts as pressed.
            results: Receives what the machines show.
        """

    def send(self, actions: Actions, machines: Numbers) -> None:
        """Begins a step of some machines.

        Args:
            actions: An index into the action set for each machine.
            machines: Indices of the machines.
        """

    def send_joysticks(self, joysticks: Joysticks, threshold: float, machines: Numbers) -> None:
        """Begins a step of some machines with continuous actions.

        Args:
            joysticks: Radius, angle and fire for each machine.
            threshold: Deflection from which a direction or the button counts as pressed.
            machines: Indices of the machines.
        """

    def send_strengths(self, actions: Actions, strengths: npt.NDArray[np.float32], machines: Numbers) -> None:
        """Begins a step of some machines whose paddles are turned.

        Args:
            actions: An index into the action set for each machine.
            strengths: How far each paddle is turned; 1 is the usual step.
            machines: Indices of the machines.
        """

    def send_resets(self, seeds: Seeds | None) -> None:
        """Begins a reset of all machines.

        Args:
            seeds: A seed for each machine, or None.
        """

    def receive(self, results: Results) -> None:
        """Waits for machines that were sent.

        Args:
            results: Receives what they show. It has a column for each machine to wait for.
        """

    def reset(self, reset_mask: Bools | None, seeds: Seeds | None, results: Results) -> None:
        """Resets machines.

        Args:
            reset_mask: Which machines to reset, or None for all.
            seeds: A seed for each machine, or None.
            results: Receives what all machines show.
        """

    def show(self, results: Results) -> None:
        """Reads what all machines show, without stepping them.

        Args:
            results: Receives what the machines show.
        """

    def playing(self) -> int:
        """Returns how many machines were sent and not yet received."""

    def save(self, machine: int, include_rng: bool) -> _core.SavedMachine:
        """Saves the state of a machine.

        Args:
            machine: Index of the machine.
            include_rng: Whether the state includes the random generators.

        Returns:
            The state.
        """

    def restore(self, machine: int, state: _core.SavedMachine) -> None:
        """Restores the state of a machine.

        Args:
            machine: Index of the machine.
            state: A state of a machine with the same game and stack.
        """

    def screen(self, machine: int) -> Pixels:
        """Draws the screen of a machine.

        Args:
            machine: Index of the machine.

        Returns:
            uint8 array of shape (height, 160, 3).
        """

    def numbers_of_actions(self) -> list[int]:
        """Returns the size of the action set of each machine."""

    def actions_of(self, machine: int) -> list[int]:
        """Lists the action set of a machine.

        Args:
            machine: Index of the machine.

        Returns:
            Numbers of `Action`.
        """

    def image_warnings(self) -> list[str]:
        """Returns a warning for each image whose game has a rule that was written for another image."""

    def height(self) -> int:
        """Returns the number of rows of the screens."""
