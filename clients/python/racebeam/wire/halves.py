"""Calls about many machines in two halves: one begins, and the other waits for the results."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..errors import InvalidInput
from ..vector.results import Numbers, Results


class Halves:
    """Splits a call into a half that begins it, and `receive`, which ends it. No other call may come between them."""

    _count: int
    _pending: Callable[[Results], None] | None = None  # the second half of the call that began

    def playing(self) -> int:
        """Returns how many machines were sent and not yet received: all or none."""
        return 0 if self._pending is None else self._count

    def drop(self, results: Results) -> None:
        """Receives what was sent, and drops it.

        Args:
            results: Scratch memory.
        """
        self.receive(results)

    def receive(self, results: Results) -> None:
        """Ends the call that began.

        Args:
            results: Receives its results.

        Raises:
            InvalidInput: If no call began.
        """
        raise NotImplementedError

    def _check_all(self, machines: Numbers) -> None:
        if not np.array_equal(machines, range(self._count)):
            raise InvalidInput(
                f"environments {machines} are to play; servers play all {self._count} environments together"
            )

    def _check_half(self, is_second: bool) -> None:
        if is_second and self._pending is None:
            raise InvalidInput(f"0 environments play, and a receive takes {self._count}; send some first")
        if not is_second and self._pending is not None:
            raise InvalidInput(f"{self._count} environments play; receive them first")

    def _take_pending(self) -> Callable[[Results], None]:
        pending, self._pending = self._pending, None
        assert pending is not None
        return pending
