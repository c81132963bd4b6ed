"""AtariVectorEnv: many environments in one, stepped together, in this process or on a server."""

from __future__ import annotations

import operator
import os
from collections.abc import Callable, Sequence
from typing import Any, Literal, Protocol, SupportsIndex, Union

import numpy as np
import numpy.typing as npt
from gymnasium import error, spaces
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space

from . import _core, images, xla
from .arguments import WrongType, WrongValue, either, flag, image, real, seconds, whole
from .errors import InvalidInput
from .vector_results import Bools, Numbers, Pixels, Results
from .vector_settings import SEEDS, autoreset_of, settings_of
from .wire.remote_machines import Halves, RemoteMachines
from .wire.spread_machines import SpreadMachines

__all__ = ["AtariVectorEnv"]

Rom = Union[str, os.PathLike[str], bytes]
Info = dict[str, Any]
Seeds = Union[SupportsIndex, Sequence[SupportsIndex | None], npt.NDArray[np.integer[Any]]]
Step = tuple[Pixels, npt.NDArray[np.int32], Bools, Bools, Info]  # observations, rewards, terminated, truncated
RAM_SIZE, SCREEN_WIDTH = 128, 160
MOST_ENVS = 10**7  # the memory sets a lower limit


class Machines(Protocol):
    """What plays: _core.VectorMachines here, RemoteMachines on a server, SpreadMachines on several. `seeds`: -1 for none."""

    def step(self, actions: npt.NDArray[np.int64], results: Results) -> None: ...
    def step_joysticks(self, joysticks: npt.NDArray[np.float32], threshold: float, results: Results) -> None: ...
    def send(self, actions: npt.NDArray[np.int64], machines: Numbers) -> None: ...
    def send_joysticks(self, joysticks: npt.NDArray[np.float32], threshold: float, machines: Numbers) -> None: ...
    def send_strengths(
        self, actions: npt.NDArray[np.int64], strengths: npt.NDArray[np.float32], machines: Numbers
    ) -> None: ...
    def send_resets(self, seeds: npt.NDArray[np.int64] | None) -> None: ...
    def receive(self, results: Results) -> None: ...
    def reset(self, chosen: Bools | None, seeds: npt.NDArray[np.int64] | None, results: Results) -> None: ...
    def show(self, results: Results) -> None: ...
    def save(self, machine: int, include_rng: bool) -> _core.SavedMachine: ...
    def restore(self, machine: int, state: _core.SavedMachine) -> None: ...
    def screen(self, machine: int) -> Pixels: ...
    def numbers_of_actions(self) -> list[int]: ...
    def actions_of(self, machine: int) -> list[int]: ...
    def height(self) -> int: ...


class AtariVectorEnv(VectorEnv[Any, Any, Any]):
    """Environments of one game, or of several, on threads. By default, they show what ale_py's AtariVectorEnv shows.

    game: its name, as racebeam.games() has it, or a list of one for each environment. Several games need the same number
        of actions, which full_action_space gives them.
    num_envs: how many; with a list of games, its length. batch_size: recv() waits for so many; 0: for all.
    num_threads: 0: one for each processor that the process may use. thread_affinity_offset: threads are bound to the
        processor of this number, among those that the process may use, and to those after it; -1: to none.
    max_num_frames_per_episode, repeat_action_probability, full_action_space, continuous, continuous_action_threshold,
        mode, difficulty: as AtariEnv has them.
    autoreset_mode: NEXT_STEP, SAME_STEP or DISABLED, as Gymnasium defines them, or their names.
    img_height, img_width, grayscale, stack_num: an observation is so many screens of this size, oldest first. They have 9
        rows to those of the game's screen, and 1 to 160 columns; 0: as many as that has. There are 1 to 16 screens.
    obs_type: "rgb" or "grayscale" makes them screens of full size instead, and "ram" one array of 128 bytes.
    frameskip: frames of a step, 1 to 1000; a step stops where the episode ends. maxpool: a screen is the brighter of the
        last two of them, pixel by pixel.
    noop_max, use_fire_reset: an episode begins with FIRE, if the game has it, and with up to noop_max - 1 no-ops, drawn.
        noop_max is 0 to 1000.
    start: their order: "fire-noops", "noops-fire" as EnvPool has it, or "baselines" as Stable-Baselines3.
    lives: what a lost life does. "ignored"; "told": the step is terminated, the episode goes on (life_loss_info of ale_py);
        "end": the episode ends, and the next one goes on with the game, as in DQN; "restart": the next one is a new game
        (episodic_life of ale_py).
    stack_start: at first a stack has "zeros", or "repeats" the first screen.
    reward_clipping: the reward of a step is clipped to -1..1.
    preset: of racebeam.presets; it says what those arguments are that are None.
    rules: "ale-0.12", or "fixed". rom: the image, a path or its bytes; None: the one that racebeam.find_image() finds.
    seed: of the first environment, until a reset has another one; the next has one more; None: at random.
    render_mode: "rgb_array" lets render() return the pictures.
    server: the environments run there; token, timeout: as racebeam.connect() has them. They are of one game,
        and batch_size is num_envs; without use_fire_reset, start is "fire-noops". A list spreads the environments over
        servers. If one is lost, its episodes are truncated, and its environments begin new ones on the others; info["lost"]
        says where.

    Rewards are int32. info has env_id, lives, frame_number, episode_frame_number, raw_reward, the reward before it was
    clipped, and game_over, whatever lives and limits say: an array each. With SAME_STEP, where episodes end, also final_obs,
    _final_obs, final_info and _final_info, as Gymnasium has them. The arrays are the caller's, and stay as they are.

    Two threads take turns. Raises InvalidInput for what cannot be; TypeError for a wrong type; IndexError for an action or an
    environment that is not there; ClosedEnvironmentError after close(); RuntimeError in a child process after a fork;
    with a server, also Refused, ConnectionError and TimeoutError, after which the environments are of no use.
    """

    _xla_infos: tuple[str, ...] = ("env_id", "lives", "frame_number", "episode_frame_number", "raw_reward", "game_over")
    metadata: dict[str, Any] = {"render_modes": ["rgb_array"], "render_fps": 15}
    _check_game = staticmethod(images.check_name)

    def __init__(
        self,
        game: str | Sequence[str],
        num_envs: int | None = None,
        *,
        batch_size: int = 0,
        num_threads: int = 0,
        thread_affinity_offset: int = -1,
        max_num_frames_per_episode: int | None = None,
        repeat_action_probability: float | None = None,
        full_action_space: bool | None = None,
        continuous: bool = False,
        continuous_action_threshold: float = 0.5,
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
        img_height: int = 84,
        img_width: int = 84,
        grayscale: bool = True,
        stack_num: int = 4,
        frameskip: int | None = None,
        maxpool: bool = True,
        noop_max: int | None = None,
        episodic_life: bool = False,
        life_loss_info: bool = False,
        reward_clipping: bool | None = None,
        use_fire_reset: bool | None = None,
        preset: str = "ale",
        mode: int | None = None,
        difficulty: int | None = None,
        obs_type: Literal["rgb", "grayscale", "ram"] | None = None,
        lives: str | None = None,
        start: str = "fire-noops",
        stack_start: str = "zeros",
        rules: str = "ale-0.12",
        rom: Rom | None = None,
        seed: SupportsIndex | None = None,
        render_mode: Literal["rgb_array"] | None = None,
        server: str | Sequence[str] | None = None,
        token: str | None = None,
        timeout: float | None = None,
    ) -> None:
        arguments = locals()
        names, game_of_env = self._games(game, num_envs)
        settings = self._settings(arguments, len(game_of_env))
        self.num_envs = len(game_of_env)
        self.batch_size: int = settings["batch_size"] or self.num_envs
        self.autoreset_mode = autoreset_of(autoreset_mode)
        self.metadata = {**type(self).metadata, "autoreset_mode": self.autoreset_mode}
        self.render_mode = render_mode
        self.grayscale: bool = not settings["rgb"]
        self.continuous = flag("continuous", continuous)
        self.continuous_action_threshold = real("continuous_action_threshold", continuous_action_threshold)
        self._shows_ram = obs_type == "ram"
        self._machines: Any = _machines(
            names, game_of_env, image(rom), settings, server, token, seconds("timeout", timeout)
        )
        self._make_spaces(settings)
        self._received = np.arange(self.num_envs, dtype=np.int32)
        self._has_finals = self.autoreset_mode is AutoresetMode.SAME_STEP

    def _settings(self, arguments: dict[str, Any], num_envs: int) -> dict[str, Any]:
        return settings_of(arguments, num_envs)

    def _games(self, game: str | Sequence[str], num_envs: int | None) -> tuple[list[str], Numbers]:
        """The names of the games, and the position among them of each environment's."""
        if isinstance(game, str):
            self._check_game(game)
            return [game], np.zeros(whole("num_envs", either(num_envs, 1), 1, MOST_ENVS), np.int32)
        if not isinstance(game, Sequence):
            raise WrongType(f"game is {game!r}; it takes a name, or a list of names")
        if num_envs is not None and num_envs != len(game):
            raise WrongValue(f"game has {len(game)} names, but num_envs is {num_envs!r}")
        whole("num_envs", len(game), 1, MOST_ENVS)
        for name in game:
            if not isinstance(name, str):
                raise WrongType(f"game has {name!r} in its list; it takes names of games")
        names = list(dict.fromkeys(game))
        for name in names:
            self._check_game(name)
        return names, np.array([names.index(name) for name in game], np.int32)

    def _make_spaces(self, settings: dict[str, Any]) -> None:
        shape: tuple[int, ...] = (RAM_SIZE,)
        if not self._shows_ram:
            shape = (
                settings["stack"],
                settings["height"] or self._machines.height(),
                settings["width"] or SCREEN_WIDTH,
            )
            shape += () if self.grayscale else (3,)
        self.single_observation_space = spaces.Box(0, 255, shape, np.uint8)
        counts = sorted(set(self._machines.numbers_of_actions()))
        if self.continuous:
            low, high = np.array([0, -np.pi, 0], np.float32), np.array([1, np.pi, 1], np.float32)
            self.single_action_space: spaces.Space[Any] = spaces.Box(low, high, dtype=np.float32)
        elif len(counts) == 1:
            self.single_action_space = spaces.Discrete(counts[0])
        else:
            raise InvalidInput(
                f"the games have {' and '.join(map(str, counts))} actions; full_action_space=True gives them the same"
            )
        self.observation_space = batch_space(self.single_observation_space, self.batch_size)
        self.action_space = batch_space(self.single_action_space, self.batch_size)
        self._shape = shape

    # Playing

    def reset(
        self, *, seed: Seeds | None = None, options: dict[str, Any] | None = None, out: Pixels | None = None
    ) -> tuple[Pixels, Info]:
        """New episodes. A seed powers the first environment on anew, and the next with one more; of a list or array, each has
        its own, and None or -1 is no seed.

        options["reset_mask"]: an array of bools that chooses environments; the others are shown as they are.
        out: the array that becomes the observations; None: a new one.
        Steps that were sent and not received are played to their end, and what they show is dropped.
        KeyboardInterrupt ends a long call, as it ends step().
        """
        self._check_open()
        if not isinstance(options, (dict, type(None))):
            raise TypeError(f"options are {options!r}; they must be a dict")
        mask = self._mask((options or {}).get("reset_mask"))
        seeds = self._seeds(seed, mask)
        results = self._room(out)
        if mask is not None and self.batch_size < self.num_envs:
            raise InvalidInput("reset_mask is given with batch_size < num_envs; it needs batch_size to be num_envs")
        self._drop_pending()
        if self.batch_size == self.num_envs:
            self._machines.reset(mask, seeds, results)
        else:
            self._machines.send_resets(seeds)
            self._machines.receive(results)
        return self._begun(results)

    def _drop_pending(self) -> None:
        """Receives what was sent and not received, and forgets it."""
        pending = int(self._machines.playing())
        if pending == 0:
            return
        receive = self._machines.drop if isinstance(self._machines, Halves) else self._machines.receive
        receive(self._room(None, pending))

    def step(self, actions: npt.ArrayLike, *, out: Pixels | None = None) -> Step:
        """An action for each environment; with batch_size, for each of those that the last call returned.

        What a signal's handler raises, such as KeyboardInterrupt, ends a long call. Each environment has then made the step, or is
        as it was, and reset() or restore() makes them agree. With batch_size, the step goes on, and recv() returns it.
        """
        self._check_open()
        meant: Any = self._joysticks(actions) if self.continuous else self._indices(actions)
        if self.batch_size < self.num_envs:
            self._send(meant)
            return self.recv(out=out)
        results = self._room(out)
        if self.continuous:
            self._machines.step_joysticks(meant, self.continuous_action_threshold, results)
        else:
            self._machines.step(meant, results)
        return self._shown(results)

    def send(self, actions: npt.ArrayLike) -> None:
        """Begins a step of the environments that the last call returned."""
        self._check_open()
        self._send(self._joysticks(actions) if self.continuous else self._indices(actions))

    def recv(self, *, out: Pixels | None = None) -> Step:
        """What those batch_size environments show that have finished first. After KeyboardInterrupt, the next recv() returns it."""
        self._check_open()
        results = self._room(out)
        self._machines.receive(results)
        return self._shown(results)

    def _send(self, meant: npt.NDArray[Any]) -> None:
        if self.continuous:
            self._machines.send_joysticks(meant, self.continuous_action_threshold, self._ready())
        else:
            self._machines.send(meant, self._ready())

    def _ready(self) -> Numbers:
        """The environments that the last call returned. Before the first one, those are all."""
        if len(self._received) != self.batch_size:
            raise InvalidInput("no environment was received yet; call reset() first")
        return self._received

    def show(self) -> tuple[Pixels, Info]:
        """What all environments show now, such as after restore()."""
        self._check_open()
        results = self._room(None, self.num_envs)
        self._machines.show(results)
        results.rewards[:] = results.raw_rewards[:] = 0  # nothing was played
        return self._seen(results), self._info(results)

    # Seeds and actions

    def _seeds(self, seed: Any, mask: Bools | None) -> npt.NDArray[np.int64] | None:
        """One for each environment, also for those that are not in the mask."""
        return None if seed is None else self._seeds_of(seed, self.num_envs)

    @staticmethod
    def _seeds_of(seed: Any, count: int) -> npt.NDArray[np.int64]:
        is_array = isinstance(seed, np.ndarray) and seed.ndim > 0
        if not is_array and not isinstance(seed, Sequence):
            return _seed(seed) + np.arange(count, dtype=np.int64)
        if is_array and (seed.dtype.kind not in "iuO"):
            raise TypeError(f"the seeds have the type {seed.dtype}; they must be integers")
        if is_array and seed.ndim > 1:
            raise InvalidInput(f"the seeds have the shape {seed.shape}; they must have {(count,)}")
        seeds = [-1 if one is None else _seed(one, -1) for one in seed]
        if len(seeds) != count:
            raise InvalidInput(
                f"there are {len(seeds)} seeds for {count} environments; give one entry per sub-environment, or one seed"
            )
        return np.array(seeds, np.int64)

    def _mask(self, mask: Any) -> Bools | None:
        if mask is None:
            return None
        if not isinstance(mask, np.ndarray) or mask.dtype != np.bool_:
            raise TypeError(f"reset_mask is {mask!r}; it must be a boolean numpy array")
        if mask.shape != (self.num_envs,):
            raise InvalidInput(f"reset_mask has the shape {mask.shape}; it must have shape {(self.num_envs,)}")
        return np.ascontiguousarray(mask)

    def _indices(self, actions: Any, count: int | None = None) -> npt.NDArray[np.int64]:
        """Of so many environments; None: of a batch."""
        array = array_of(actions)
        if array.dtype.kind not in "iu":
            raise TypeError(f"actions have the type {array.dtype}; they must be integers")
        self._check_shape(array, (), count)
        if array.dtype.kind == "u" and (large := array[array > np.iinfo(np.int64).max]).size:
            raise IndexError(
                f"action {large[0]} is out of range; there are 0 to {self._machines.numbers_of_actions()[0] - 1}"
            )
        return np.ascontiguousarray(array, np.int64)

    def _joysticks(self, actions: Any) -> npt.NDArray[np.float32]:
        array = array_of(actions)
        if array.dtype.kind not in "fiu":
            raise TypeError(f"actions have the type {array.dtype}; they must be numbers: radius, angle and fire")
        self._check_shape(array, (3,))
        with np.errstate(over="ignore"):
            joysticks = np.ascontiguousarray(array, np.float32)
        if not np.isfinite(joysticks).all():
            raise InvalidInput(
                f"a part of the actions is {joysticks[~np.isfinite(joysticks)][0]}, which is not a finite number"
            )
        return joysticks

    def _check_shape(self, actions: npt.NDArray[Any], rest: tuple[int, ...], count: int | None = None) -> None:
        expected = (self.batch_size if count is None else count, *rest)
        if actions.shape != expected:
            raise InvalidInput(f"actions have the shape {actions.shape}; they must have {expected}")

    # What is shown

    def _room(self, out: Pixels | None, envs: int | None = None) -> Results:
        """Memory for what is shown next, of so many environments; None: of a batch."""
        shape = (self.batch_size if envs is None else envs, *self._shape)
        if out is None:
            out = np.empty(shape, np.uint8)
        elif not (isinstance(out, np.ndarray) and out.dtype == np.uint8 and out.shape == shape and out.flags.carray):
            raise InvalidInput(f"out must be a writable, contiguous array of uint8 with the shape {shape}")
        finals = np.empty(shape, np.uint8) if self._has_finals else None
        observations, ram = (None, out) if self._shows_ram else (out, None)
        return Results.around(observations, ram, shape[0], finals)

    def _seen(self, results: Results) -> Any:
        return results.ram if self._shows_ram else results.observations

    def _begun(self, results: Results) -> tuple[Pixels, Info]:
        observations, *_, info = self._shown(results)
        return observations, info

    def _shown(self, results: Results) -> Step:
        self._received = results.env_id.copy()
        observations, info = self._seen(results), self._info(results)
        if self._has_finals and results.finished.any():
            self._add_finals(info, observations, results)
        return observations, results.rewards, results.terminated, results.truncated, info

    def _info(self, results: Results) -> Info:
        lost = {"lost": self._machines.lost} if isinstance(self._machines, SpreadMachines) else {}
        return {
            "env_id": results.env_id,
            "lives": results.lives,
            "frame_number": results.frames,
            "episode_frame_number": results.episode_frames,
            "raw_reward": results.raw_rewards,
            "game_over": results.game_over,
            **lost,
        }

    def _add_finals(self, info: Info, _: Any, results: Results) -> None:
        """As Gymnasium's environments have them: objects, None where no episode ended."""
        finished, finals = results.finished, results.final_observations
        assert finals is not None and results.final_numbers is not None
        objects = np.empty(self.batch_size, object)
        for env in np.flatnonzero(finished):
            objects[env] = finals[env].copy()
        numbers = np.where(finished, results.final_numbers, 0)
        named = dict(zip(("lives", "frame_number", "episode_frame_number"), numbers))
        info["final_obs"], info["_final_obs"] = objects, finished
        info["final_info"], info["_final_info"] = {**named, **{f"_{key}": finished for key in named}}, finished

    def render(self) -> tuple[Pixels, ...] | None:
        """The picture of each environment, height x 160 x 3."""
        self._check_open()
        if self.render_mode is None:
            raise error.Error(
                "render_mode is None, so render() shows nothing; make the environments with render_mode='rgb_array'"
            )
        return tuple(self._machines.screen(env) for env in range(self.num_envs))

    def xla(self) -> tuple[Any, Callable[..., Any], Callable[..., Any]]:
        """For programs that JAX compiles: a handle, reset(handle, seed=None, reset_mask=None) and step(handle, actions).

        Both return the handle for the next call, and a tuple of what they show, as reset() and step() of this class do, in arrays
        of JAX on the processor. Seeds end at 2,147,483,647. An array of JAX gives the lower 31 bits of its seeds, so
        that jax.random.bits() draws some. Not with SAME_STEP, batch_size or a server. Errors of a compiled program are
        jax.errors.JaxRuntimeError. Raises ImportError without JAX.
        """
        self._check_open()
        return xla.functions(self, self._xla_infos)

    def machines(self) -> Machines:
        """What plays; for other modules of this package."""
        self._check_open()
        machines: Machines = self._machines
        return machines

    # States and the end

    def save(self, env: int, *, include_rng: bool = True) -> _core.SavedMachine:
        """The state of one environment, with its stack of screens. It can be pickled.

        include_rng: with the generators of sticky actions and of no-ops, so that later episodes are the same, too.
        """
        self._check_open()
        return self.machines().save(operator.index(env), include_rng)

    def restore(self, env: int, state: _core.SavedMachine) -> None:
        """Takes an environment to a state of its game. show() shows it. Raises InvalidInput for a state of another game, or whose
        observations have another shape.
        """
        self._check_open()
        self._machines.restore(operator.index(env), state)

    def __reduce__(self) -> tuple[Any, ...]:
        raise TypeError(
            f"{type(self).__name__} has threads, and can be neither pickled nor copied; make another one with the same "
            "arguments, and take it to the states that save(env) gives, which can be pickled, by restore(env, state)"
        )

    def close_extras(self, **kwargs: Any) -> None:
        """Ends the threads, or the session, and gives the memory back."""
        machines = self.__dict__.get("_machines")  # there are none where the constructor failed
        self._machines = _Closed()
        if isinstance(machines, (RemoteMachines, SpreadMachines)):
            machines.close()

    def _check_open(self) -> None:
        if self.closed:
            raise _closed()


class _Closed:
    """In the place of machines that were closed, also by another thread in the middle of a call."""

    def __getattr__(self, name: str) -> Any:
        raise _closed()


def _closed() -> error.ClosedEnvironmentError:
    return error.ClosedEnvironmentError("these environments were closed; make new ones")


def _machines(
    names: list[str],
    game_of_env: Numbers,
    rom: Rom | None,
    settings: dict[str, Any],
    server: str | Sequence[str] | None,
    token: str | None,
    timeout: float | None,
) -> Machines:
    if len(names) > 1 and (rom is not None or server is not None):
        raise WrongValue(f"there are {len(names)} games; rom and server take one")
    if server is not None:
        kind: Any = RemoteMachines if isinstance(server, str) else SpreadMachines
        machines: Machines = kind(server, token, timeout, names[0], rom, len(game_of_env), settings)
        return machines
    found = [(images.find(name) if rom is None else rom, name) for name in names]
    chosen = _core.VectorSettings()
    for name, value in settings.items():
        setattr(chosen, name, value)
    return _core.VectorMachines(found, game_of_env, chosen)


def _seed(value: Any, least: int = SEEDS[0]) -> int:
    """Raises TypeError for what is no whole number."""
    try:
        seed = operator.index(value)
    except TypeError:
        raise TypeError(f"the seed is {value!r}; it takes a whole number") from None
    if not least <= seed <= SEEDS[1]:
        raise InvalidInput(f"the seed is {seed}; it takes {least} to {SEEDS[1]}")
    return seed


def array_of(values: Any) -> npt.NDArray[Any]:
    """Raises InvalidInput for what is none."""
    try:
        return np.asarray(values)
    except ValueError:  # rows of several lengths
        raise InvalidInput(f"{values!r} is given for one array; its rows have several lengths") from None
