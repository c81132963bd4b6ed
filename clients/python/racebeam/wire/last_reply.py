"""The results of machines on a server, read from its last reply to `open`, `step` or `restart`."""

from __future__ import annotations

import re

import numpy as np

from ..vector.results import Pixels, Results
from .messages import Reply, Values
from .session import Session

NUMBERS = ("reward", "raw_reward", "lives", "frame", "episode_frame")  # rows of Results.numbers
FLAGS = ("terminated", "truncated", "game_over")
VALUE = re.compile(r"=(-?\d+)")
FINAL_NUMBERS = ("final_lives", "final_frame", "final_episode_frame")


class LastReply:
    """The last reply about the machines of a session. It is decoded when its values are needed.

    Args:
        session: The session of the machines.
        count: Number of machines.
        field: Name of the observation in the protocol.
    """

    def __init__(self, session: Session, count: int, field: str) -> None:
        self._session = session
        self._count = count
        self._field = field
        names = " ".join(f"{name}=" for name in (*NUMBERS, *FLAGS, field))
        self._plain = "machines=" + f" | {names}" * count + " raw="
        self._reply: Reply | None = None  # until it is decoded
        self._decoded: list[Values] = []

    def keep(self, reply: Reply) -> None:
        """Makes a reply the last one.

        Args:
            reply: The reply, as `Session._await_plain` returned it.
        """
        self._reply = reply

    @property
    def values(self) -> list[Values]:
        """The values of each machine. The caller may change the list."""
        if self._reply is not None:
            self._decoded, self._reply = self._session._decode_plain(self._reply)[1:], None
        return self._decoded

    @values.setter
    def values(self, values: list[Values]) -> None:
        self._decoded, self._reply = values, None

    def fill(self, results: Results) -> None:
        """Fills results from the reply.

        Args:
            results: Receives what the machines show.
        """
        results.env_id[:] = range(self._count)
        if self._reply is None or not self._fill_at_once(self._reply, results):
            self._fill_each(results)

    def _fill_at_once(self, reply: Reply, results: Results) -> bool:
        """Reads a reply that has exactly the observed fields as a whole, many times faster than field by field.

        Returns:
            Whether the reply has them.
        """
        if VALUE.sub("=", reply.text) != self._plain:
            return False
        observations = _observations(results)
        values = np.array([int(text) for text in VALUE.findall(reply.text)[1:-1]]).reshape(self._count, -1)
        if len(reply.data) != observations.nbytes or (values[:, -1] != observations[0].nbytes).any():
            return False
        results.numbers[:-1] = values[:, : len(NUMBERS)].T
        results.flags[(0, 1, 3), :] = values[:, len(NUMBERS) : -1].T
        results.finished[:] = False
        observations[:] = np.frombuffer(reply.data, np.uint8).reshape(observations.shape)
        return True

    def _fill_each(self, results: Results) -> None:
        observations = _observations(results)
        for machine, values in enumerate(self.values):
            results.numbers[:-1, machine] = [values[name] for name in NUMBERS]
            results.flags[(0, 1, 3), machine] = [values[name] for name in FLAGS]
            observations[machine] = np.frombuffer(values[self._field], np.uint8).reshape(observations.shape[1:])
            results.finished[machine] = FINAL_NUMBERS[0] in values
            if results.finished[machine]:
                self._fill_final(results, machine, values, "final_")

    def fill_finals(self, results: Results) -> None:
        """Fills the final observations from the reply, as if all episodes had ended with it.

        Args:
            results: Receives the final observations.
        """
        for machine, values in enumerate(self.values):
            self._fill_final(results, machine, values, "")
        results.finished[:] = True

    def _fill_final(self, results: Results, machine: int, values: Values, prefix: str) -> None:
        assert results.final_observations is not None and results.final_numbers is not None
        finals = results.final_observations
        finals[machine] = np.frombuffer(values[prefix + self._field], np.uint8).reshape(finals.shape[1:])
        results.final_numbers[:, machine] = [values[prefix + name.removeprefix("final_")] for name in FINAL_NUMBERS]

    def screen(self, machine: int) -> Pixels:
        """Returns the screen of a machine, uint8 of shape (height, 160, 3)."""
        return np.frombuffer(self.values[machine]["rgb"], np.uint8).reshape(-1, 160, 3).copy()


def _observations(results: Results) -> Pixels:
    observations = results.ram if results.observations is None else results.observations
    assert observations is not None
    return observations
