"""The machines of AtariVectorEnv on several servers. If a server is lost, its environments move to another one."""

from __future__ import annotations

import contextlib
import dataclasses
import queue
import secrets
import threading
import warnings
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from .._core import SavedMachine
from ..errors import InvalidInput
from ..vector.autoreset import AutoresetMode
from ..vector.machines import Actions, Joysticks, Seeds
from ..vector.results import Bools, Numbers, Pixels, Results
from ..vector_options import VectorOptions
from .action_words import joystick_words, with_strengths
from .halves import Halves
from .messages import Refused
from .remote_machines import RemoteMachines

LEAVING = ("stopping", "busy", "idle", "internal")  # the errors after which a server closes the session


def _is_loss(error: Exception) -> bool:
    """Returns whether an exception means that the server is lost. Otherwise, the request was wrong."""
    cause = error if isinstance(error, Refused) else error.__cause__
    return isinstance(error, (ConnectionError, TimeoutError)) or (isinstance(cause, Refused) and cause.code in LEAVING)


class _Part:
    """The environments that one server plays: a range of rows."""

    machines: RemoteMachines

    def __init__(self, rows: slice, address: str) -> None:
        self.rows, self.address = rows, address
        self.is_fresh = False  # the part moved, and the next step shows the first observations of its new episodes

    @property
    def count(self) -> int:
        return int(self.rows.stop - self.rows.start)

    @property
    def names(self) -> str:
        return f"environments {self.rows.start} to {self.rows.stop - 1}"


class SpreadMachines(Halves):
    """Machines on several servers, with the methods of the protocol `Machines`.

    The numbers of environments on two servers differ by one at most. Servers beyond the number of environments are
    spare.

    When a server is lost, the step truncates its episodes, and returns the observations of the step before. `lost` says
    which environments these are. They begin new games, with new seeds, on the server that plays the fewest
    environments. A lost server is not asked again. Losing a server during `reset` or `show` does not truncate episodes:
    these calls return the environments of the new server, and set `lost`.

    A server that does not answer at the start is lost, too. Its environments begin on another server, with the seeds
    that they would have had. A warning names the server, and the first call sets `lost`.

    Args:
        servers: Addresses of the servers.
        token: Token that the servers ask for, or None.
        timeout: Seconds to wait for each reply, or None.
        game: Name of the game.
        rom: Path or bytes of the image to send, or None for the servers' own.
        options: Options of the environments.

    Attributes:
        lost: bool array of shape (num_envs,): which environments lost their server in the last call.

    Raises:
        TypeError: If `servers` are not addresses.
        InvalidInput: If a server does not play these options.
        ConnectionError: If no server answers. Every method raises it when no server is left.

    Every method raises what the methods of `RemoteMachines` raise.
    """

    def __init__(
        self,
        servers: Sequence[str],
        token: str | None,
        timeout: float | None,
        game: str,
        rom: Any,
        options: VectorOptions,
    ) -> None:
        if not options.is_sync:
            raise InvalidInput(
                f"batch_size is {options.batch_size}; servers play all {options.num_envs} environments together"
            )
        if not servers or not all(isinstance(server, str) for server in servers):
            raise TypeError(f"server is {servers!r}; it takes an address, or a list of addresses")
        self._connection, self._count, self._options = (token, timeout, game, rom), options.num_envs, options
        self._turn, self._is_cut = threading.Lock(), False
        self._servers = list(dict.fromkeys(servers))  # the servers that are not lost
        self.lost: Bools = np.zeros(self._count, np.bool_)
        self._lost_before: Bools = np.zeros(self._count, np.bool_)  # losses that no call has returned yet
        shares = np.array_split(np.arange(self._count), min(len(self._servers), self._count))
        self._parts = [
            _Part(slice(int(share[0]), int(share[-1]) + 1), address)
            for share, address in zip(shares, self._servers, strict=False)
        ]
        try:
            missing = self._open_all()
            for part, _ in missing:
                self._lost_before[part.rows] = True
                self._servers.remove(part.address)
            for part, failure in missing:
                self._place(part, [failure for _, failure in missing], self._seed_of(part))
                warnings.warn(f"{part.names} begin on {part.address}: {failure}", RuntimeWarning, stacklevel=4)
        except BaseException:
            self.close()
            raise

    def _open_all(self) -> list[tuple[_Part, Exception]]:
        """Opens the environments of all parts at the same time, since an address may wait for its server.

        Returns:
            The parts whose server is absent, and why.

        Raises:
            Exception: Any other error of a part, as soon as it occurs.
        """
        opened: queue.SimpleQueue[tuple[_Part, Exception | None]] = queue.SimpleQueue()

        def open_one(part: _Part) -> None:
            try:
                part.machines = self._connect(part.address, part.count, self._seed_of(part))
                opened.put((part, None))
            except Exception as error:
                opened.put((part, error))

        for part in self._parts:
            threading.Thread(target=open_one, args=(part,), daemon=True).start()
        missing = []
        for _ in self._parts:
            part, error = opened.get()
            if error is not None and not _is_loss(error):
                raise error
            if error is not None:
                missing.append((part, error))
        return sorted(missing, key=lambda one: one[0].rows.start)

    def _seed_of(self, part: _Part) -> int:
        return int((self._options.seed + part.rows.start) % 2**32)

    def _connect(self, address: str, count: int, seed: int) -> RemoteMachines:
        options = dataclasses.replace(self._options, num_envs=count, batch_size=count, seed=seed)
        return RemoteMachines(address, *self._connection, options)

    def numbers_of_actions(self) -> list[int]:
        """Returns the size of the action set of each machine."""
        return [number for part in self._parts for number in part.machines.numbers_of_actions()]

    def actions_of(self, machine: int) -> list[int]:
        """Returns the action set of a machine, as numbers of `Action`."""
        return self._parts[0].machines.actions_of(0)

    def image_warnings(self) -> list[str]:
        """Returns a warning if the game's rule was written for another image."""
        return self._parts[0].machines.image_warnings()

    def height(self) -> int:
        """Returns the number of rows of the screens."""
        return self._parts[0].machines.height()

    def close(self) -> None:
        """Ends the sessions."""
        for part in self._parts:
            if hasattr(part, "machines"):  # the constructor may have failed
                part.machines.close()

    # Playing

    def step(self, actions: Actions, results: Results) -> None:
        """Steps all machines."""
        words = self._words(actions)
        self._exchange(lambda results: self._begin(words)(results), results)

    def step_joysticks(self, joysticks: Joysticks, threshold: float, results: Results) -> None:
        """Steps all machines with continuous actions."""
        words = self._joystick_words(joysticks, threshold)
        self._exchange(lambda results: self._begin(words)(results), results)

    def send(self, actions: Actions, machines: Numbers) -> None:
        """Begins a step of all machines."""
        self._send(self._words(actions), machines)

    def send_joysticks(self, joysticks: Joysticks, threshold: float, machines: Numbers) -> None:
        """Begins a step of all machines with continuous actions."""
        self._send(self._joystick_words(joysticks, threshold), machines)

    def send_strengths(self, actions: Actions, strengths: npt.NDArray[np.float32], machines: Numbers) -> None:
        """Begins a step of all machines with the strengths of their paddles; 1 is the usual step."""
        words = zip(self._parts, self._words(actions), strict=True)
        self._send([with_strengths(acts, strengths[part.rows]) for part, acts in words], machines)

    def _send(self, words: list[list[Any]], machines: Numbers) -> None:
        self._check_all(machines)
        with self._exclusively():
            self._pending = self._begin(words)

    def send_resets(self, seeds: Seeds | None) -> None:
        """Begins a reset of all machines."""
        with self._exclusively():
            self._pending = lambda results: self._reset(None, seeds, results)

    def receive(self, results: Results) -> None:
        """Ends the step or reset that began."""
        self._exchange(lambda results: self._take_pending()(results), results, is_second=True)

    def drop(self, results: Results) -> None:
        """Receives what was sent, and drops it. The next call returns the losses of this one.

        Args:
            results: Scratch memory.
        """
        self.receive(results)
        self._lost_before |= self.lost

    def _words(self, actions: Actions) -> list[list[Any]]:
        return [part.machines.words(actions[part.rows]) for part in self._parts]

    def _joystick_words(self, joysticks: Joysticks, threshold: float) -> list[list[Any]]:
        return [joystick_words(joysticks[part.rows], threshold) for part in self._parts]

    def _begin(self, words: list[list[Any]]) -> Callable[[Results], None]:
        """Begins a step on all servers at the same time.

        Args:
            words: The words of the step, by part.

        Returns:
            A function that waits for all servers.
        """
        requests = [
            ("restart", "0" * len(acts)) if part.is_fresh else ("step", *acts)
            for part, acts in zip(self._parts, words, strict=True)
        ]
        failures = [
            self._find_loss(part.machines.begin, *request) for part, request in zip(self._parts, requests, strict=True)
        ]

        def finish(results: Results) -> None:
            for index, part in enumerate(self._parts):
                rows = results.select(part.rows)
                failures[index] = failures[index] or self._find_loss(part.machines.finish, rows)
            for part, failure in zip(self._parts, failures, strict=True):
                if failure is not None:
                    self._truncate(part, failure, results.select(part.rows))
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
        """Lets one thread at a time use the sessions.

        If an interrupt such as Ctrl-C leaves a request without its reply, all sessions end. A later request would take
        that reply for its own, and a session that ended by itself would look like a lost server.
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
                if not isinstance(error, Exception) or any(part.machines.is_waiting() for part in self._parts):
                    self._is_cut = True
                    self.close()
                raise

    @staticmethod
    def _find_loss(call: Callable[..., None], *arguments: object) -> Exception | None:
        """Calls a function. Returns the exception that means that the server is lost, and raises any other."""
        try:
            call(*arguments)
        except Exception as error:
            if _is_loss(error):
                return error
            raise
        return None

    def reset(self, reset_mask: Bools | None, seeds: Seeds | None, results: Results) -> None:
        """Resets the machines that `reset_mask` selects; all if it is None."""
        self._exchange(lambda results: self._reset(reset_mask, seeds, results), results)

    def _reset(self, reset_mask: Bools | None, seeds: Seeds | None, results: Results) -> None:
        def reset_part(part: _Part) -> None:
            rows = part.rows
            mask = None if reset_mask is None else reset_mask[rows]
            part.machines.reset(mask, None if seeds is None else seeds[rows], results.select(rows))
            part.is_fresh = False

        self._ask_each(reset_part)

    def show(self, results: Results) -> None:
        """Reads what all machines show, without stepping them."""

        def show_part(part: _Part) -> None:
            part.machines.show(results.select(part.rows))

        self._exchange(lambda _: self._ask_each(show_part), results)

    def _ask_each(self, ask: Callable[[_Part], None]) -> None:
        for part in self._parts:
            self._ask(part, ask)

    def _ask(self, part: _Part, ask: Callable[[_Part], None]) -> None:
        """Asks the server of a part. If that server is lost, asks the next one."""
        while (failure := self._find_loss(ask, part)) is not None:
            self._move(part, failure)

    # Losing a server

    def _truncate(self, part: _Part, failure: Exception, results: Results) -> None:
        last = part.machines.last
        self._move(part, failure)
        if self._options.autoreset_mode is AutoresetMode.SAME_STEP:
            self._ask(part, lambda part: part.machines.show(results))
            last.fill_finals(results)
        else:
            last.fill(results)
            part.is_fresh = self._options.autoreset_mode is AutoresetMode.NEXT_STEP
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
        """Opens environments for the part.

        Args:
            part: The part.
            failures: Failures of the servers before, for the message of the ConnectionError.
            seed: Seed of the first environment.

        Raises:
            ConnectionError: If no server is left.
        """
        failures = failures[:]
        for address in sorted(self._servers, key=self._load_of):
            try:
                part.machines = self._connect(address, part.count, seed)
            except (OSError, InvalidInput, Refused) as error:
                failures.append(error)
                continue
            part.address = address
            return
        why = "; ".join(map(str, failures))
        raise ConnectionError(f"no server is left for {part.names}: {why}") from failures[-1]

    def _load_of(self, address: str) -> int:
        return sum(part.count for part in self._parts if part.address == address)

    def screen(self, machine: int) -> Pixels:
        """Returns the screen of a machine, uint8 of shape (height, 160, 3)."""
        self._check_half(False)
        part, row = self._find_part(machine)
        return part.machines.screen(row)

    # States of one environment. If the server is lost, these calls raise a ConnectionError, and the next step goes on
    # with another server. That step returns the first observations of new episodes, or what was restored meanwhile.

    def save(self, machine: int, include_rng: bool) -> SavedMachine:
        """Returns the state of a machine."""
        part, row = self._find_part(machine)
        with self._exclusively():
            return part.machines.save(row, include_rng)

    def restore(self, machine: int, state: SavedMachine) -> None:
        """Restores the state of a machine."""
        part, row = self._find_part(machine)
        with self._exclusively():
            part.machines.restore(row, state)

    def _find_part(self, machine: int) -> tuple[_Part, int]:
        """Returns the part that plays an environment, and its row there."""
        for part in self._parts:
            if part.rows.start <= machine < part.rows.stop:
                return part, machine - part.rows.start
        raise IndexError(f"environment {machine} is out of range; accepted: 0 to {self._count - 1}")
