"""The machines of AtariVectorEnv on a server, played by `open`, `step` and `restart` of the line protocol."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from .._core import Action, ActionSet, ConsoleAction, ResetOrder, SavedMachine, VectorSettings, controller_actions
from ..errors import InvalidInput
from ..vector.machines import Actions, Joysticks, Seeds
from ..vector.results import Bools, Numbers, Pixels, Results
from ..vector_options import VectorOptions
from .action_words import joystick_words, with_strengths
from .halves import Halves
from .last_reply import FLAGS, NUMBERS, LastReply
from .remote import STATE, RemoteInterface

NO_LIMITS = (-(2**31), 2**31 - 1)


def _word(member: Any) -> str:
    """Returns the word of the protocol for the member of an enumeration."""
    return str(member.name).lower().replace("_", "-")


class RemoteMachines(Halves):
    """Machines on a server, with the methods of the protocol `Machines`. All machines step together.

    Args:
        server: Address of the server.
        token: Token that the server requires, or None.
        timeout: Seconds to wait for each reply, or None.
        game: Name of the game.
        rom: Path or bytes of the image to send, or None for the server's own.
        options: Options of the environments.

    Raises:
        InvalidInput: If a server does not play these options.

    Every method raises what the methods of `RemoteInterface` raise.
    """

    def __init__(
        self, server: str, token: str | None, timeout: float | None, game: str, rom: Any, options: VectorOptions
    ) -> None:
        if not options.is_sync:
            raise InvalidInput(
                f"batch_size is {options.batch_size}; a server plays all {options.num_envs} environments together"
            )
        settings = options._core_settings()
        self._count = options.num_envs
        self._turn = threading.Lock()
        self._machine = RemoteInterface(server, token, timeout)
        self._session = self._machine.session
        self._load(game, rom, settings, {"rules": options.rules, **options._console()})
        self._actions = self._read_actions(settings)
        field = _field(settings, self.height())
        self.last = LastReply(self._session, self._count, field)
        self._machine.ask(
            self._session.observe,
            *NUMBERS,
            *FLAGS,
            field + (":raw" if "raw" in self._session._offered else ":base64"),
            *(["rgb:zlib"] if settings.screens else []),
        )
        self._open(settings)

    def _load(self, game: str, rom: Any, settings: VectorSettings, more: dict[str, str]) -> None:
        limits = {"reward_min": settings.reward_min, "reward_max": settings.reward_max}
        self._machine.load(
            rom,
            game,
            {
                "seed": settings.seed or 1,  # the server would draw a seed for 0
                "frame_skip": settings.frame_skip,
                "sticky": settings.sticky,
                "max_episode_frames": settings.max_episode_frames,
                "action_set": _word(settings.action_set),
                "noop_max": settings.noop_max,
                **more,
                **{side: "none" if limit in NO_LIMITS else limit for side, limit in limits.items()},
            },
        )
        modes = {"mode": settings.mode, "difficulty": settings.difficulty}
        values = {name: value for name, value in modes.items() if value is not None}
        if values:
            self._machine.ask(self._session.set, **values)

    def _open(self, settings: VectorSettings) -> None:
        if not settings.fire and settings.start is not ResetOrder.FIRE_NOOPS:
            raise InvalidInput(
                f"start is {_word(settings.start)!r} and use_fire_reset is False; with this start, a server takes True"
            )
        self.last.values = self._machine.ask(
            self._session.open,
            self._count,
            _word(settings.autoreset),
            steps="frames",
            start=_word(settings.start) if settings.fire else "noops",
            life_loss=_word(settings.lives),
            stack=_word(settings.stack_start),
            pool=int(settings.pool),
        )
        if settings.seed == 0:
            self.last.values = self._machine.ask(self._session.restart, seed=0)

    def _read_actions(self, settings: VectorSettings) -> list[int]:
        machine = self._machine
        if settings.action_set is ActionSet.CONSOLE:
            more = controller_actions(machine.getControllers()[0])
            return [action.value for action in (*Action, *ConsoleAction, *more)]
        is_legal = settings.action_set is ActionSet.LEGAL
        return [action.value for action in (machine.getLegalActionSet() if is_legal else machine.getMinimalActionSet())]

    def numbers_of_actions(self) -> list[int]:
        """Returns the size of the action set of each machine."""
        return [len(self._actions)] * self._count

    def actions_of(self, machine: int) -> list[int]:
        """Returns the action set of a machine, as numbers of `Action`."""
        return self._actions

    def image_warnings(self) -> list[str]:
        """Returns a warning if the game's rule was written for another image."""
        return list(filter(None, [self._machine.image_warning()]))

    def height(self) -> int:
        """Returns the number of rows of the screens."""
        height, _ = self._machine.getScreenDims()
        return height

    def close(self) -> None:
        """Ends the session."""
        self._machine.close()

    # Playing

    def step(self, actions: Actions, results: Results) -> None:
        """Steps all machines."""
        self._ask(results, "step", *self.words(actions))

    def step_joysticks(self, joysticks: Joysticks, threshold: float, results: Results) -> None:
        """Steps all machines with continuous actions."""
        self._ask(results, "step", *joystick_words(joysticks, threshold))

    def send(self, actions: Actions, machines: Numbers) -> None:
        """Begins a step of all machines."""
        self._send(self.words(actions), machines)

    def send_joysticks(self, joysticks: Joysticks, threshold: float, machines: Numbers) -> None:
        """Begins a step of all machines with continuous actions."""
        self._send(joystick_words(joysticks, threshold), machines)

    def send_strengths(self, actions: Actions, strengths: npt.NDArray[np.float32], machines: Numbers) -> None:
        """Begins a step of all machines with the strengths of their paddles; 1 is the usual step."""
        self._send(with_strengths(self.words(actions), strengths), machines)

    def _send(self, words: Sequence[object], machines: Numbers) -> None:
        self._check_all(machines)
        with self._exclusively():
            self.begin("step", *words)
            self._pending = self.finish

    def send_resets(self, seeds: Seeds | None) -> None:
        """Begins a reset of all machines."""
        with self._exclusively():
            self._pending = lambda results: self._reset(None, seeds, results)

    def receive(self, results: Results) -> None:
        """Ends the step or reset that began."""
        with self._exclusively(is_second=True):
            self._take_pending()(results)

    def reset(self, reset_mask: Bools | None, seeds: Seeds | None, results: Results) -> None:
        """Resets the machines that `reset_mask` selects; all if it is None."""
        with self._exclusively():
            self._reset(reset_mask, seeds, results)

    def _reset(self, reset_mask: Bools | None, seeds: Seeds | None, results: Results) -> None:
        """Resets machines. One request resets all whose seeds are as the server counts them up."""
        masks: dict[int | None, list[str]] = {}
        for machine in range(self._count) if reset_mask is None else np.flatnonzero(reset_mask):
            seed = -1 if seeds is None else int(seeds[machine])
            first = None if seed < 0 else (seed - int(machine)) % 2**32
            masks.setdefault(first, ["0"] * self._count)[machine] = "1"
        for first, mask in (masks or {None: ["0"] * self._count}).items():
            self.begin("restart", "".join(mask), **({} if first is None else {"seed": first}))
            self.finish(results)

    def show(self, results: Results) -> None:
        """Reads what all machines show, without stepping them."""
        self._ask(results, "restart", "0" * self._count)

    def _ask(self, results: Results, *words: object, **settings: object) -> None:
        with self._exclusively():
            self.begin(*words, **settings)
            self.finish(results)

    @contextlib.contextmanager
    def _exclusively(self, *, is_second: bool = False) -> Iterator[None]:
        """Lets one thread at a time use the session. Ends it if an exception leaves a request without its reply."""
        self._session._check_process()  # after a fork, a thread that the child lacks may hold the lock
        with self._turn:
            self._check_half(is_second)
            try:
                yield
            except BaseException:
                if self.is_waiting():
                    self._session._abort()
                raise

    def begin(self, *words: object, **settings: object) -> None:
        """Sends a request about the machines.

        The caller calls `finish` next, and no other thread may come between. If an exception comes between, the session
        has to end.

        Args:
            *words: Words of the request.
            **settings: Settings of the request.
        """
        self._session._begin(*words, **settings)

    def is_waiting(self) -> bool:
        """Returns whether a reply is still to come, which a later request would mistake for its own."""
        return bool(self._session._unanswered)

    def check_process(self) -> None:
        """Checks that this is the process that opened the session.

        Raises:
            RuntimeError: In a child process after a fork.
        """
        self._session._check_process()

    def finish(self, results: Results) -> None:
        """Receives the reply to the request that `begin` sent.

        Args:
            results: Receives what the machines show.
        """
        self.last.keep(self._machine.ask(self._session._await_plain))
        self.last.fill(results)

    def words(self, actions: Actions) -> list[int]:
        """Converts actions to the words of `step`.

        Args:
            actions: int64 array with an index for each machine.

        Returns:
            The numbers of the actions.

        Raises:
            IndexError: If an index is out of range.
        """
        if actions.min() < 0 or actions.max() >= len(self._actions):
            wrong = next(int(action) for action in actions if not 0 <= action < len(self._actions))
            raise IndexError(f"action {wrong} is out of range; accepted: 0 to {len(self._actions) - 1}")
        return [self._actions[action] for action in actions]

    # States, which pass through the session under one name

    def save(self, machine: int, include_rng: bool) -> SavedMachine:
        """Returns the state of a machine.

        Args:
            machine: Index of the machine.
            include_rng: Whether the state has the random generators.

        Returns:
            The state, which can also be restored in this process.

        Raises:
            IndexError: If the index is out of range.
        """
        self._check_machine(machine)
        with self._exclusively():
            self._machine.ask(self._session.save, STATE, generator=int(include_rng), machine=machine)
            data = self._machine.ask(self._session.export_state, STATE, episode=1)
            self._machine.ask(self._session.drop, STATE)
        state = SavedMachine.__new__(SavedMachine)
        state.__setstate__(data)
        return state

    def restore(self, machine: int, state: SavedMachine) -> None:
        """Restores the state of a machine.

        Args:
            machine: Index of the machine.
            state: The state.

        Raises:
            IndexError: If the index is out of range.
            InvalidInput: If the state belongs to another game, or its observations have another shape.
        """
        self._check_machine(machine)
        with self._exclusively():
            self._machine.ask(self._session.import_state, STATE, state.__getstate__())
            try:
                self.last.values[machine] = self._machine.ask(self._session.restore, STATE, machine=machine)
            finally:
                if not self.is_waiting():
                    self._machine.ask(self._session.drop, STATE)

    def _check_machine(self, machine: int) -> None:
        if not 0 <= machine < self._count:
            raise IndexError(f"environment {machine} is out of range; accepted: 0 to {self._count - 1}")

    def screen(self, machine: int) -> Pixels:
        """Returns the screen of a machine, uint8 of shape (height, 160, 3)."""
        self._check_half(False)
        return self.last.screen(machine)


def _field(settings: VectorSettings, height: int) -> str:
    """Returns the name of the observation in the protocol."""
    if settings.stack == 0:
        return "ram"
    kind = "rgb" if settings.rgb else "grey"
    return f"{kind}{settings.width or 160}x{settings.height or height}x{settings.stack}"
