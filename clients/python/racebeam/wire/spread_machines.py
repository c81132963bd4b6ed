"""The machines of AtariVectorEnv on several servers. What one server played goes on elsewhere when that server is lost."""

from __future__ import annotations

import contextlib
import queue
import secrets
import threading
import warnings
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from .._core import Autoreset, SavedMachine
from ..errors import InvalidInput
from ..vector_results import Bools, Numbers, Pixels, Results
from .client import Refused
from .remote_machines import Halves, RemoteMachines, with_strengths

LEAVING = ("stopping", "busy", "idle", "internal")  # the errors after which a server closes the session


def _is_loss(error: Exception) -> bool:
    """Whether the server is lost, in place of a bad request."""
    refused = error if isinstance(error, Refused) else error.__cause__
    return isinstance(error, (ConnectionError, TimeoutError)) or (
        isinstance(refused, Refused) and refused.code in LEAVING
    )


class _Part:
    """The environments that one server plays: a range of rows."""

    machines: RemoteMachines

    def __init__(self, rows: slice, address: str) -> None:
        self.rows, self.address = rows, address
        self.is_fresh = False  # it was moved, and the next step shows the beginning of its episodes


class SpreadMachines(Halves):
    """Has the methods of _core.VectorMachines. Raises what RemoteMachines does; ConnectionError when no server is left.

    Each server plays as many environments as the next, give or take one. Those beyond the number of environments are spare.

    When a server is lost, its episodes are truncated in that step, with the observations of the step before, and `lost` says
    where. Its environments then begin new games on the server that plays the fewest, with new seeds. A server that was lost is
    not asked again. A loss in reset() or show() is no truncation: the environments of the new server are shown, and `lost`
    says where.

    A server that is absent at the start is lost, too: its environments begin elsewhere, with the seeds that they would have had.
    A warning names it, and `lost` of the first call says where.
    """

    def __init__(
        self,
        servers: Sequence[str],
        token: str | None,
        timeout: float | None,
        game: str,
        rom: Any,
        count: int,
        settings: dict[str, Any],
    ) -> None:
        if settings["batch_size"] not in (0, count):
            raise InvalidInput(
                f"batch_size is {settings['batch_size']}; servers play all {count} environments together"
            )
        if not servers or not all(isinstance(server, str) for server in servers):
            raise TypeError(f"server is {servers!r}; it takes an address, or a list of addresses")
        self._how, self._count, self._settings = (token, timeout, game, rom), count, settings
        self._turn, self._is_cut = threading.Lock(), False
        self._servers = list(dict.fromkeys(servers))  # those that are not lost
        self.lost: Bools = np.zeros(count, np.bool_)  # of the last call
        self._lost_before: Bools = np.zeros(count, np.bool_)  # what no call has told yet
        shares = np.array_split(np.arange(count), min(len(self._servers), count))
        self._parts = [
            _Part(slice(int(share[0]), int(share[-1]) + 1), address) for address, share in zip(self._servers, shares)
        ]
        try:
            absent = self._open_all()
            for part, _ in absent:
                self._lost_before[part.rows] = True
                self._servers.remove(part.address)
            for part, failure in absent:
                self._place(part, [failure for _, failure in absent], self._seed_of(part))
                warnings.warn(
                    f"environments {part.rows.start} to {part.rows.stop - 1} begin on {part.address}: {failure}",
                    RuntimeWarning,
                    stacklevel=4,
                )
        except BaseException:
            self.close()
            raise

    def _open_all(self) -> list[tuple[_Part, Exception]]:
        """Opens the environments of all parts at the same time, since an address may wait for its server. Returns the parts
        whose server is absent, and why. Raises what else goes wrong, as soon as it does.
        """
        opened: queue.SimpleQueue[tuple[_Part, Exception | None]] = queue.SimpleQueue()

        def open_one(part: _Part) -> None:
            try:
                part.machines = self._opened(part.address, part.rows, self._seed_of(part))
                opened.put((part, None))
            except Exception as error:
                opened.put((part, error))

        for part in self._parts:
            threading.Thread(target=open_one, args=(part,), daemon=True).start()
        absent = []
        for _ in self._parts:
            part, error = opened.get()
            if error is not None and not _is_loss(error):
                raise error
            if error is not None:
                absent.append((part, error))
        return sorted(absent, key=lambda one: one[0].rows.start)

    def _seed_of(self, part: _Part) -> int:
        return int((self._settings["seed"] + part.rows.start) % 2**32)

    def _opened(self, address: str, rows: slice, seed: int) -> RemoteMachines:
        settings = {**self._settings, "seed": seed, "batch_size": 0}
        return RemoteMachines(address, *self._how, rows.stop - rows.start, settings)

    def numbers_of_actions(self) -> list[int]:
        return [number for part in self._parts for number in part.machines.numbers_of_actions()]

    def actions_of(self, machine: int) -> list[int]:
        return self._parts[0].machines.actions_of(0)

    def height(self) -> int:
        return self._parts[0].machines.height()

    def close(self) -> None:
        """Ends the sessions."""
        for part in self._parts:
            if hasattr(part, "machines"):  # the constructor may have failed
                part.machines.close()

    # Playing

    def step(self, actions: npt.NDArray[np.int64], results: Results) -> None:
        words = self._words(actions)
        self._exchange(lambda results: self._begun(words)(results), results)

    def step_joysticks(self, joysticks: npt.NDArray[np.float32], threshold: float, results: Results) -> None:
        words = self._words_of(joysticks, threshold)
        self._exchange(lambda results: self._begun(words)(results), results)

    def send(self, actions: npt.NDArray[np.int64], machines: Numbers) -> None:
        self._send(self._words(actions), machines)

    def send_joysticks(self, joysticks: npt.NDArray[np.float32], threshold: float, machines: Numbers) -> None:
        self._send(self._words_of(joysticks, threshold), machines)

    def send_strengths(
        self, actions: npt.NDArray[np.int64], strengths: npt.NDArray[np.float32], machines: Numbers
    ) -> None:
        words = self._words(actions)
        self._send([with_strengths(acts, strengths[part.rows]) for part, acts in zip(self._parts, words)], machines)

    def _send(self, words: list[list[Any]], machines: Numbers) -> None:
        self._check_all(machines)
        with self._exclusively():
            self._awaited = self._begun(words)

    def send_resets(self, seeds: npt.NDArray[np.int64] | None) -> None:
        with self._exclusively():
            self._awaited = lambda results: self._reset(None, seeds, results)

    def receive(self, results: Results) -> None:
        self._exchange(lambda results: self._take()(results), results, is_second=True)

    def drop(self, results: Results) -> None:
        self.receive(results)
        self._lost_before |= self.lost  # the next call tells it

    def _words(self, actions: npt.NDArray[np.int64]) -> list[list[Any]]:
        return [part.machines.words(actions[part.rows]) for part in self._parts]

    def _words_of(self, joysticks: npt.NDArray[np.float32], threshold: float) -> list[list[Any]]:
        return [part.machines.words_of(joysticks[part.rows], threshold) for part in self._parts]

    def _begun(self, words: list[list[Any]]) -> Callable[[Results], None]:
        """All servers play at the same time. What it returns awaits them."""
        requests = [
            ("restart", "0" * len(acts)) if part.is_fresh else ("step", *acts) for part, acts in zip(self._parts, words)
        ]
        failures = [self._failure(part.machines.begin, *request) for part, request in zip(self._parts, requests)]

        def finish(results: Results) -> None:
            for index, part in enumerate(self._parts):
                failures[index] = failures[index] or self._failure(part.machines.finish, results.of(part.rows))
            for part, failure in zip(self._parts, failures):
                if failure is not None:
                    self._truncate(part, failure, results.of(part.rows))
                else:
                    part.is_fresh = False

        return finish

    def _exchange(self, play: Callable[[Results], None], results: Results, *, is_second: bool = False) -> None:
        with self._exclusively(is_second=is_second):
            self.lost, self._lost_before = self._lost_before, np.zeros(self._count, np.bool_)
            play(results)
        results.env_id[:] = range(self._count)

    @contextlib.contextmanager
    def _exclusively(self, *, is_second: bool = False) -> Iterator[None]:
        """A turn of one thread. Where it is cut off, such as by Ctrl-C, all sessions end: replies that are read later would be taken
        for others', and a session that ended alone for a server that is lost.
        """
        self._parts[0].machines.check_process()
        with self._turn:
            if self._is_cut:
                raise ConnectionError(
                    "the sessions have ended: they were interrupted between a request and the end of its reply"
                )
            self._check_half(is_second)
            try:
                yield
            except BaseException as error:
                if not isinstance(error, Exception) or any(part.machines.waits() for part in self._parts):
                    self._is_cut = True
                    self.close()
                raise

    @staticmethod
    def _failure(call: Callable[..., None], *arguments: object) -> Exception | None:
        """The exception that says that the server is lost, if it is."""
        try:
            call(*arguments)
        except Exception as error:
            if _is_loss(error):
                return error
            raise
        return None

    def reset(self, chosen: Bools | None, seeds: npt.NDArray[np.int64] | None, results: Results) -> None:
        self._exchange(lambda results: self._reset(chosen, seeds, results), results)

    def _reset(self, chosen: Bools | None, seeds: npt.NDArray[np.int64] | None, results: Results) -> None:
        def ask(part: _Part) -> None:
            rows = part.rows
            part.machines.reset(
                None if chosen is None else chosen[rows], None if seeds is None else seeds[rows], results.of(rows)
            )
            part.is_fresh = False

        self._each(ask)

    def show(self, results: Results) -> None:
        self._exchange(lambda results: self._each(lambda part: part.machines.show(results.of(part.rows))), results)

    def _each(self, ask: Callable[[_Part], None]) -> None:
        for part in self._parts:
            self._ask(part, ask)

    def _ask(self, part: _Part, ask: Callable[[_Part], None]) -> None:
        """Asks the server of a part, and the next one while a server is lost."""
        while (failure := self._failure(ask, part)) is not None:
            self._move(part, failure)

    # Losing a server

    def _truncate(self, part: _Part, failure: Exception, results: Results) -> None:
        last = part.machines
        self._move(part, failure)
        if self._settings["autoreset"] is Autoreset.SAME_STEP:
            self._ask(part, lambda part: part.machines.show(results))
            last.show_last_as_final(results)
        else:
            last.show_last(results)
            part.is_fresh = self._settings["autoreset"] is Autoreset.NEXT_STEP
        results.rewards[:] = results.raw_rewards[:] = 0
        results.terminated[:] = False
        results.truncated[:] = True

    def _move(self, part: _Part, failure: Exception) -> None:
        """Opens new environments for the part on the server that plays the fewest."""
        part.machines.close()
        self.lost[part.rows] = True
        self._servers = [address for address in self._servers if address != part.address]
        self._place(part, [failure], secrets.randbits(32) or 1)

    def _place(self, part: _Part, failures: list[Exception], seed: int) -> None:
        """Opens environments for the part. failures: of the servers before, which a ConnectionError says if there is no other."""
        failures = failures[:]
        for address in sorted(self._servers, key=self._load_of):
            try:
                part.machines = self._opened(address, part.rows, seed)
            except (OSError, InvalidInput, Refused) as error:
                failures.append(error)
                continue
            part.address = address
            return
        why = "; ".join(map(str, failures))
        raise ConnectionError(
            f"no server is left for environments {part.rows.start} to {part.rows.stop - 1}: {why}"
        ) from failures[-1]

    def _load_of(self, address: str) -> int:
        return sum(part.rows.stop - part.rows.start for part in self._parts if part.address == address)

    def screen(self, machine: int) -> Pixels:
        self._check_half(False)
        part, row = self._place_of(machine)
        return part.machines.screen(row)

    # States of one environment. A loss is a ConnectionError, and the next step goes on elsewhere. That step shows new episodes, and
    # also what was restored after the loss, before it plays.

    def save(self, machine: int, include_rng: bool) -> SavedMachine:
        part, row = self._place_of(machine)
        with self._exclusively():
            return part.machines.save(row, include_rng)

    def restore(self, machine: int, state: SavedMachine) -> None:
        part, row = self._place_of(machine)
        with self._exclusively():
            part.machines.restore(row, state)

    def _place_of(self, machine: int) -> tuple[_Part, int]:
        """The part that plays an environment, and its row there."""
        for part in self._parts:
            if part.rows.start <= machine < part.rows.stop:
                return part, machine - part.rows.start
        raise IndexError(f"there is no environment {machine}; there are 0 to {self._count - 1}")
