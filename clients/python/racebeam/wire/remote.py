"""ALEInterface of a game that runs on a server, with the same results, over the line protocol."""

from __future__ import annotations

import copy
import struct
from typing import Any

from .. import images
from .._core import ALEState
from .remote_game import check_types, exclusive
from .remote_play import RemotePlay

STATE = "racebeam-env"  # the name under which states pass through the session
STATE_HEAD = struct.Struct("<8s4i")  # what ALEState.serialize() has before the server's bytes


class RemoteInterface(RemotePlay):
    """One game on a server, with the methods of `racebeam.ALEInterface`.

    The interface keeps the settings, and sends them when it loads an image. If the server lacks the image, the
    interface sends it. Threads take turns; only `close` interrupts the call of another thread.

    Every method raises what the method of ALEInterface raises. It also raises ConnectionError if the server is gone,
    and TimeoutError if it does not answer in time. It raises RuntimeError in a child process after a fork, and Refused
    for a limit of the server.

    Args:
        server: Address of the server, as `racebeam.connect` takes it.
        token: Token that the server requires, or None.
        timeout: Seconds to wait for each reply, or None for no limit.

    Attributes:
        session: The session with the server.
        turn: The lock of the thread that uses the session.

    Raises:
        ConnectionError: If no server answers.
        TimeoutError: If no server answers in time.
    """

    @exclusive
    def state_hash(self) -> int:
        """Returns a hash of the state. The same state in this process has the same hash.

        Raises:
            MissingImage: If only the server has the image.
        """
        state = self.cloneState(True)
        assert self._loaded is not None
        rom, game, _ = self._loaded
        here = copy.deepcopy(self._keys)
        here.loadROM(images.find(str(game)) if rom is None else rom, game)
        here.restoreState(state)
        return here.state_hash()

    @exclusive
    @check_types
    def cloneState(self, include_rng: bool = False) -> ALEState:
        """Returns the state, which can also be restored in this process.

        Args:
            include_rng: Whether the state has the generator of sticky actions.
        """
        self.ask(self.session.save, STATE, generator=int(include_rng))
        data = self.ask(self.session.export_state, STATE)
        self.ask(self.session.drop, STATE)
        now = self._look("frame", "episode_frame")
        head = STATE_HEAD.pack(b"RBALE001", now["frame"], now["episode_frame"], self.getDifficulty(), self.getMode())
        return ALEState(head + data)

    @exclusive
    def restoreState(self, state: ALEState) -> None:
        """Restores a state.

        Args:
            state: A state of the same game.

        Raises:
            TypeError: If `state` is not an ALEState.
            InvalidInput: If the state belongs to another game.
        """
        if not isinstance(state, ALEState):
            raise TypeError(f"state is {state!r}; it takes an ALEState")
        self.ask(self.session.import_state, STATE, state.serialize()[STATE_HEAD.size :])
        self.ask(self.session.restore, STATE)
        self.ask(self.session.drop, STATE)

    @exclusive
    def cloneSystemState(self) -> ALEState:
        """Returns the state with the generator of sticky actions."""
        return self.cloneState(True)

    restoreSystemState = restoreState

    @exclusive
    def __getstate__(self) -> dict[str, Any]:
        """Returns what a copy needs to continue from the state of this game, with its own session."""
        return {
            "server": self._server,
            "token": self._token,
            "timeout": self._timeout,
            "keys": self._keys,
            "loaded": self._loaded,
            "state": self.cloneState(True) if self._loaded else None,
        }

    def __setstate__(self, state: dict[str, Any]) -> None:
        RemoteInterface.__init__(self, state["server"], state["token"], state["timeout"])
        self._keys = state["keys"]
        if state["loaded"]:
            self.load(*state["loaded"])
            self.restoreState(state["state"])
