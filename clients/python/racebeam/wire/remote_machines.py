"""The machines of AtariVectorEnv on a server: `open`, `step` and `restart` of the line protocol."""

from __future__ import annotations

import contextlib
import re
import threading
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from .._core import ActionSet, ResetOrder, Rules, SavedMachine
from ..errors import InvalidInput
from ..vector_results import Bools, Numbers, Pixels, Results
from .client import Reply, Values
from .remote import STATE, RemoteInterface

NO_LIMITS = (-(2**31), 2**31 - 1)
RULES = {Rules.ALE_0_12: "ale-0.12", Rules.FIXED: "fixed"}
NUMBERS = ("reward", "raw_reward", "lives", "frame", "episode_frame")  # rows of Results
FLAGS = ("terminated", "truncated", "game_over")
VALUE = re.compile(r"=(-?\d+)")
FINAL_NUMBERS = ("final_lives", "final_frame", "final_episode_frame")

# Actions by fire, then from down to up, then from left to right.
STICK = np.array([[[9, 5, 8], [4, 0, 3], [7, 2, 6]], [[17, 13, 16], [12, 1, 11], [15, 10, 14]]])


def _word(member: Any) -> str:
    """The protocol's word for a member of an enumeration."""
    return str(member.name).lower().replace("_", "-")


class Halves:
    """A step or reset in two halves: what began, receive() ends. Between them, nothing else is possible."""

    _count: int
    _awaited: Callable[[Results], None] | None = None  # what receive() does

    def playing(self) -> int:
        """How many machines were sent and not received."""
        return 0 if self._awaited is None else self._count

    def drop(self, results: Results) -> None:
        """Receives what was sent, whose results the caller forgets."""
        self.receive(results)

    def receive(self, results: Results) -> None:
        raise NotImplementedError

    def _check_all(self, machines: Numbers) -> None:
        if not np.array_equal(machines, range(self._count)):
            raise InvalidInput(f"environments {machines} are to play; servers play all {self._count} together")

    def _check_half(self, is_second: bool) -> None:
        if is_second and self._awaited is None:
            raise InvalidInput(f"0 machines play, and a receive takes {self._count}; send some first")
        if not is_second and self._awaited is not None:
            raise InvalidInput(f"{self._count} machines play; receive them first")

    def _take(self) -> Callable[[Results], None]:
        awaited, self._awaited = self._awaited, None
        assert awaited is not None
        return awaited


class RemoteMachines(Halves):
    """Has the methods of _core.VectorMachines. Raises what RemoteInterface does; RuntimeError in a child after a fork.

    settings: those of _core.VectorSettings, by name. timeout: of connect(). All machines step together.
    """

    def __init__(
        self,
        server: str,
        token: str | None,
        timeout: float | None,
        game: str,
        rom: Any,
        count: int,
        settings: dict[str, Any],
    ) -> None:
        if settings["batch_size"] not in (0, count):
            raise InvalidInput(
                f"batch_size is {settings['batch_size']}; a server plays all {count} environments together"
            )
        self._count = count
        self._turn = threading.Lock()
        self._machine = RemoteInterface(server, token, timeout)
        self._session = self._machine.session
        self._load(game, rom, settings)
        self._actions = self._actions_of(settings)
        self._field = _field(settings, self.height())
        self._plain = (
            "machines=" + f" | {' '.join(f'{name}=' for name in (*NUMBERS, *FLAGS, self._field))}" * count + " raw="
        )
        self._reply: Reply | None = None  # what the machines showed last, until it is decoded
        self._decoded: list[Values] = []
        self._machine.ask(
            self._session.observe,
            *NUMBERS,
            *FLAGS,
            self._field + (":raw" if "raw" in self._session.offered else ":base64"),
            *(["rgb:zlib"] if settings["screens"] else []),
        )
        self._open(settings)

    def _load(self, game: str, rom: Any, settings: dict[str, Any]) -> None:
        limits = {side: settings[side] for side in ("reward_min", "reward_max")}
        self._machine.load(
            rom,
            game,
            {
                "seed": settings["seed"] or 1,  # the server would draw one for 0
                "frame_skip": settings["frame_skip"],
                "sticky": settings["sticky"],
                "max_episode_frames": settings["max_episode_frames"],
                "action_set": _word(settings["action_set"]),
                "noop_max": settings["noop_max"],
                "rules": RULES[settings["rules"]],
                **{side: "none" if limit in NO_LIMITS else limit for side, limit in limits.items()},
            },
        )
        chosen = {name: settings[name] for name in ("mode", "difficulty") if settings[name] is not None}
        if chosen:
            self._machine.ask(self._session.set, **chosen)

    def _open(self, settings: dict[str, Any]) -> None:
        if not settings["fire"] and settings["start"] is not ResetOrder.FIRE_NOOPS:
            raise InvalidInput(f"start is {_word(settings['start'])!r} without FIRE, which a server does not play")
        self._decoded = self._machine.ask(
            self._session.open,
            self._count,
            _word(settings["autoreset"]),
            steps="frames",
            start=_word(settings["start"]) if settings["fire"] else "noops",
            lives=_word(settings["lives"]),
            stack=_word(settings["stack_start"]),
            pool=int(settings["pool"]),
        )
        if settings["seed"] == 0:
            self._decoded = self._machine.ask(self._session.restart, seed=0)

    def _actions_of(self, settings: dict[str, Any]) -> list[int]:
        machine = self._machine
        is_legal = settings["action_set"] is ActionSet.LEGAL
        return [action.value for action in (machine.getLegalActionSet() if is_legal else machine.getMinimalActionSet())]

    def numbers_of_actions(self) -> list[int]:
        return [len(self._actions)] * self._count

    def actions_of(self, machine: int) -> list[int]:
        return self._actions

    def height(self) -> int:
        height, _ = self._machine.getScreenDims()
        return height

    def close(self) -> None:
        """Ends the session."""
        self._machine.close()

    # Playing

    def step(self, actions: npt.NDArray[np.int64], results: Results) -> None:
        self._ask(results, "step", *self.words(actions))

    def step_joysticks(self, joysticks: npt.NDArray[np.float32], threshold: float, results: Results) -> None:
        self._ask(results, "step", *self.words_of(joysticks, threshold))

    def send(self, actions: npt.NDArray[np.int64], machines: Numbers) -> None:
        self._send(self.words(actions), machines)

    def send_joysticks(self, joysticks: npt.NDArray[np.float32], threshold: float, machines: Numbers) -> None:
        self._send(self.words_of(joysticks, threshold), machines)

    def send_strengths(
        self, actions: npt.NDArray[np.int64], strengths: npt.NDArray[np.float32], machines: Numbers
    ) -> None:
        self._send(with_strengths(self.words(actions), strengths), machines)

    def _send(self, words: Sequence[object], machines: Numbers) -> None:
        self._check_all(machines)
        with self._exclusively():
            self.begin("step", *words)
            self._awaited = self.finish

    def send_resets(self, seeds: npt.NDArray[np.int64] | None) -> None:
        with self._exclusively():
            self._awaited = lambda results: self._reset(None, seeds, results)

    def receive(self, results: Results) -> None:
        with self._exclusively(is_second=True):
            self._take()(results)

    def reset(self, chosen: Bools | None, seeds: npt.NDArray[np.int64] | None, results: Results) -> None:
        with self._exclusively():
            self._reset(chosen, seeds, results)

    def _reset(self, chosen: Bools | None, seeds: npt.NDArray[np.int64] | None, results: Results) -> None:
        """Machines whose seeds count up as the server counts them are reset by one request."""
        masks: dict[int | None, list[str]] = {}
        for machine in range(self._count) if chosen is None else np.flatnonzero(chosen):
            seed = -1 if seeds is None else int(seeds[machine])
            first = None if seed < 0 else (seed - int(machine)) % 2**32
            masks.setdefault(first, ["0"] * self._count)[machine] = "1"
        for first, mask in (masks or {None: ["0"] * self._count}).items():
            self.begin("restart", "".join(mask), **({} if first is None else {"seed": first}))
            self.finish(results)

    def show(self, results: Results) -> None:
        self._ask(results, "restart", "0" * self._count)

    def _ask(self, results: Results, *words: object, **settings: object) -> None:
        with self._exclusively():
            self.begin(*words, **settings)
            self.finish(results)

    @contextlib.contextmanager
    def _exclusively(self, *, is_second: bool = False) -> Iterator[None]:
        """A turn of one thread. The session ends if an exception leaves a request without its reply."""
        self._session.check_process()  # the turn may be that of a thread which a child does not have
        with self._turn:
            self._check_half(is_second)
            try:
                yield
            except BaseException:
                if self.waits():
                    self._session.cut()
                raise

    def begin(self, *words: object, **settings: object) -> None:
        """Sends a request about the machines. finish() comes next, and no other thread between them. If an exception comes between
        them, the session has to end.
        """
        self._session.begin(*words, **settings)

    def waits(self) -> bool:
        """Whether a request is without its reply, which a later request would take for its own."""
        return bool(self._session.unanswered)

    def check_process(self) -> None:
        """Raises RuntimeError in a child process after a fork."""
        self._session.check_process()

    def finish(self, results: Results) -> None:
        self._reply = self._machine.ask(self._session.receive_plain)
        self.show_last(results)

    def words(self, actions: npt.NDArray[np.int64]) -> list[int]:
        """The words of `step` that play actions. Raises IndexError."""
        if actions.min() < 0 or actions.max() >= len(self._actions):
            wrong = next(int(action) for action in actions if not 0 <= action < len(self._actions))
            raise IndexError(f"action {wrong} is out of range; there are 0 to {len(self._actions) - 1}")
        return [self._actions[action] for action in actions]

    @staticmethod
    def words_of(joysticks: npt.NDArray[np.float32], threshold: float) -> list[str]:
        """ACTION@STRENGTH of each. The comparisons are those of float32."""
        radius, angle, fire = joysticks.T
        limit = np.float32(threshold)
        parts = [(radius * part(angle.astype(np.float64)).astype(np.float32)) for part in (np.cos, np.sin)]
        column, row = (1 + (part > limit).astype(int) - (part < -limit) for part in parts)
        actions = STICK[(fire > limit).astype(int), row, column]
        return [f"{action}@{strength:.9g}" for action, strength in zip(actions, radius)]

    # States, which pass through the session under one name

    def save(self, machine: int, include_rng: bool) -> SavedMachine:
        self._check_machine(machine)
        with self._exclusively():
            self._machine.ask(self._session.save, STATE, random=int(include_rng), machine=machine)
            data = self._machine.ask(self._session.export_state, STATE, whole=1)
            self._machine.ask(self._session.drop, STATE)
        state = SavedMachine.__new__(SavedMachine)
        state.__setstate__(data)
        return state

    def restore(self, machine: int, state: SavedMachine) -> None:
        if not isinstance(state, SavedMachine):
            raise TypeError(f"state is {state!r}; it takes what save() returned")
        self._check_machine(machine)
        with self._exclusively():
            self._machine.ask(self._session.import_state, STATE, state.__getstate__())
            try:
                self._last[machine] = self._machine.ask(self._session.restore, STATE, machine=machine)
            finally:
                if not self.waits():
                    self._machine.ask(self._session.drop, STATE)

    def _check_machine(self, machine: int) -> None:
        if not 0 <= machine < self._count:
            raise IndexError(f"there is no environment {machine}; there are 0 to {self._count - 1}")

    # What is shown

    @property
    def _last(self) -> list[Values]:
        """What the machines showed last."""
        if self._reply is not None:
            self._decoded, self._reply = self._session.decode_plain(self._reply)[1:], None
        return self._decoded

    def show_last(self, results: Results) -> None:
        """What the last reply had."""
        results.env_id[:] = range(self._count)
        if self._reply is None or not self._show_plain(self._reply, results):
            self._show_any(results)

    def _show_plain(self, reply: Reply, results: Results) -> bool:
        """Returns whether the reply has exactly what was observed. It is then read as a whole, which is many times faster."""
        if VALUE.sub("=", reply.text) != self._plain:
            return False
        seen = _seen(results)
        values = np.array([int(text) for text in VALUE.findall(reply.text)[1:-1]]).reshape(self._count, -1)
        if len(reply.data) != seen.nbytes or (values[:, -1] != seen[0].nbytes).any():
            return False
        results.numbers[:-1] = values[:, : len(NUMBERS)].T
        results.flags[(0, 1, 3), :] = values[:, len(NUMBERS) : -1].T
        results.finished[:] = False
        seen[:] = np.frombuffer(reply.data, np.uint8).reshape(seen.shape)
        return True

    def _show_any(self, results: Results) -> None:
        seen = _seen(results)
        for machine, values in enumerate(self._last):
            results.numbers[:-1, machine] = [values[name] for name in NUMBERS]
            results.flags[(0, 1, 3), machine] = [values[name] for name in FLAGS]
            seen[machine] = np.frombuffer(values[self._field], np.uint8).reshape(seen.shape[1:])
            results.finished[machine] = FINAL_NUMBERS[0] in values
            if results.finished[machine]:
                self._fill_finals(results, machine, values, "final_")

    def show_last_as_final(self, results: Results) -> None:
        """As if the episodes had ended with it."""
        for machine, values in enumerate(self._last):
            self._fill_finals(results, machine, values, "")
        results.finished[:] = True

    def _fill_finals(self, results: Results, machine: int, values: Values, prefix: str) -> None:
        assert results.final_observations is not None and results.final_numbers is not None
        finals = results.final_observations
        finals[machine] = np.frombuffer(values[prefix + self._field], np.uint8).reshape(finals.shape[1:])
        results.final_numbers[:, machine] = [values[prefix + name.removeprefix("final_")] for name in FINAL_NUMBERS]

    def screen(self, machine: int) -> Pixels:
        self._check_half(False)
        return np.frombuffer(self._last[machine]["rgb"], np.uint8).reshape(-1, 160, 3).copy()


def _seen(results: Results) -> Pixels:
    seen = results.ram if results.observations is None else results.observations
    assert seen is not None
    return seen


def with_strengths(words: Sequence[object], strengths: npt.NDArray[np.float32]) -> list[str]:
    """The words of `step` with how far each paddle is turned."""
    return [f"{word}@{strength:.9g}" for word, strength in zip(words, strengths)]


def _field(settings: dict[str, Any], height: int) -> str:
    """The protocol's name of an observation."""
    if settings["stack"] == 0:
        return "ram"
    kind = "rgb" if settings["rgb"] else "grey"
    return f"{kind}{settings['width'] or 160}x{settings['height'] or height}x{settings['stack']}"
