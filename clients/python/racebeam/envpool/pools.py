"""EnvPool's interface: make("Pong-v5", env_type="gymnasium", num_envs=8), with its arguments and the keys of its infos.

What differs from EnvPool 1.2.5: the games are those of ALE 0.12, and not 0.7.5. env_type="gym" has the interface of Gym 0.21,
as EnvPool 0.6 had it: reset() returns observations, and step() four values; gym_reset_return_info=True undoes that. All
environments are stepped, or as many as recv() returned; reset() alone takes some. Resizing is by area. An action that is out
of range is an IndexError. There is no xla(); racebeam.AtariVectorEnv has one. A spec's least reward is negative. render() returns the
pictures with render_mode=None, too, in the size of the game; there is neither another size nor a window.
"""

from __future__ import annotations

import re
import sys
import warnings
from collections.abc import Mapping
from typing import Any, Literal, NamedTuple, overload

import gymnasium
import numpy as np
import numpy.typing as npt
from gymnasium import spaces
from gymnasium.vector import AutoresetMode, VectorEnv

from . import ale_games, images
from .arguments import flag, whole
from .envpool_spec import EnvSpec, dm_specs, rendered_env, whole_config
from .errors import InvalidInput, UnknownGame
from .interface import ALEInterface
from .registration import rom_id_to_name
from .vector_env import MOST_ENVS, AtariVectorEnv, Info
from .vector_results import Bools, Numbers, Pixels, Results

__all__ = ["DmEnvPool", "GymEnvPool", "GymnasiumEnvPool", "TimeStep", "list_all_envs", "make", "make_dm", "make_gym", "make_gymnasium",
           "make_spec"]

COUNTS = {"num_envs": MOST_ENVS, "max_episode_steps": 2**31 - 1, "frame_skip": 1000}


def _games() -> dict[str, str]:
    """The game of each task."""
    return {f"{rom_id_to_name(game)}-v5": game for game in images.titles() if game not in ale_games.FOR_TWO}


def list_all_envs() -> list[str]:
    """Pong-v5 and so on."""
    return list(_games())


def _game(task_id: str) -> str:
    if task_id not in _games():
        raise UnknownGame(f"there is no task {task_id!r}; list_all_envs() lists them")
    return _games()[task_id]


class _Envs(AtariVectorEnv):
    """Infos have EnvPool's keys."""

    def __init__(self, game: str, config: dict[str, Any]) -> None:
        count, limit, skip = (whole(name, config[name], 1, most) for name, most in COUNTS.items())
        self._elapsed = np.zeros(count, np.int32)
        self._begins = np.ones(count, np.bool_)  # the next result of an environment begins an episode
        self._is_over = np.ones(count, np.bool_)  # and a game
        self._stays = np.zeros(count, np.bool_)  # or shows an environment as it was
        self.began: Bools = self._begins  # the last results did
        self._lives = np.zeros(count, np.int32)
        self.lost: Bools = self._begins  # by the last results, a life
        super().__init__(
            game, count, batch_size=config["batch_size"], num_threads=config["num_threads"],
            thread_affinity_offset=config["thread_affinity_offset"], stack_num=config["stack_num"],
            max_num_frames_per_episode=min(limit * skip, 2**31 - 1), frameskip=skip,
            noop_max=config["noop_max"], use_fire_reset=config["use_fire_reset"], reward_clipping=config["reward_clip"],
            img_height=config["img_height"], img_width=config["img_width"], grayscale=config["gray_scale"],
            mode=_optional(config["mode"]), difficulty=_optional(config["difficulty"]),
            full_action_space=config["full_action_space"], repeat_action_probability=config["repeat_action_probability"],
            lives="end" if config["episodic_life"] else "ignored", start="noops-fire", stack_start="repeats",
            render_mode="rgb_array")

    def begin(self, mask: Bools) -> None:
        """Those of the mask are reset next."""
        self._begins |= mask
        self._is_over |= mask
        self._stays[:] = ~mask

    def send_resets(self, seed: Any) -> None:
        self._check_open()
        self._machines.send_resets(self._seeds(seed))

    @property
    def received(self) -> Numbers:
        """The environments of the last results."""
        return self._received

    def _room(self, out: Pixels | None, envs: int | None = None) -> Results:
        return super()._room(out, envs)._replace(ram=np.empty((envs or self.batch_size, 128), np.uint8))

    def _info(self, results: Results) -> Info:
        ids = results.env_id
        stays = self._stays[ids]
        self._stays[ids] = False
        self.began = self._begins[ids] & ~stays
        elapsed = np.where(self.began & self._is_over[ids], 0, self._elapsed[ids] + ~(self.began | stays)).astype(np.int32)
        self._elapsed[ids] = elapsed
        self.lost = results.lives < self._lives[ids]
        self._lives[ids] = results.lives
        self._begins[ids] = results.terminated | results.truncated
        self._is_over[ids] = results.game_over | results.truncated
        return {
            "env_id": ids,
            "players": {"env_id": ids},
            "lives": results.lives,
            "reward": results.raw_rewards.astype(np.float32),
            "terminated": results.game_over.astype(np.int32),
            "ram": results.ram,
            "elapsed_step": elapsed,
        }


def _optional(number: int) -> int | None:
    return None if np.array_equal(number, -1) else number


class _Pool:
    """What all kinds have. Results are a batch of observations, rewards, terminations, truncations and the info."""

    def __init__(self, task_id: str, config: dict[str, Any]) -> None:
        game, self.config = _game(task_id), whole_config(task_id, config)
        self._envs = _Envs(game, self.config)
        self.num_envs, self.batch_size = self._envs.num_envs, self._envs.batch_size
        self._seeds: Any = self.config["env_seed"] if np.size(self.config["env_seed"]) else self.config["seed"]
        self._is_new, self._shown_by_render = True, rendered_env(config, self.num_envs)
        self.action_space = self.single_action_space = self._envs.single_action_space
        actions = self._envs.machines().numbers_of_actions()[0]
        self.spec: Any = EnvSpec(self.config, actions, _observations(self.config))
        self.observation_space = self.single_observation_space = self.spec.observation_space

    def __len__(self) -> int:
        return self.num_envs

    @property
    def is_async(self) -> bool:
        return self.batch_size < self.num_envs

    @property
    def all_env_ids(self) -> npt.NDArray[np.int32]:
        return np.arange(self.num_envs, dtype=np.int32)

    def observation_spec(self) -> Any:
        """As dm_env has it."""
        return self.spec.observation_spec()

    def action_spec(self) -> Any:
        """As dm_env has it."""
        return self.spec.action_spec()

    def seed(self, seed: Any = None) -> None:
        """Has no effect, as in EnvPool."""
        warnings.warn("seed() has no effect; give seed to make()", stacklevel=2)

    def render(self, env_ids: Any = None) -> Pixels:
        pictures = self._envs.render() or ()
        chosen = np.atleast_1d(self._shown_by_render if env_ids is None else env_ids)
        if chosen.size == 0:
            raise InvalidInput("env_ids is empty; it takes one environment or more")
        return np.stack([pictures[env] for env in chosen])

    def xla(self) -> Any:
        raise NotImplementedError("racebeam.envpool has no xla()")

    def close(self) -> None:
        self._envs.close()

    def async_reset(self) -> None:
        """Begins new episodes of all environments; recv() returns the first."""
        self._envs.begin(np.ones(self.num_envs, np.bool_))
        self._envs.send_resets(self._first_seeds())

    def send(self, action: Any, env_id: Any = None) -> None:
        """Begins a step of the environments that were received last."""
        self._envs.send(self._meant(action, env_id))

    def _first_seeds(self) -> Any:
        seeds, self._seeds, self._is_new = self._seeds, None, False
        return seeds

    def _reset(self, env_id: Any, options: dict[str, Any] | None) -> tuple[Any, Any, Any, Any, Info]:
        if not isinstance(options, (Mapping, type(None))):
            raise InvalidInput(f"options is {options!r}; it takes a dictionary, or None")
        mask = (options or {}).get("reset_mask")
        if env_id is not None:
            mask = np.isin(self.all_env_ids, self._ids(env_id))
        self._envs.begin(np.ones(self.num_envs, np.bool_) if mask is None else mask)
        observations, info = self._envs.reset(seed=self._first_seeds(), options=None if mask is None else {"reset_mask": mask})
        nothing = np.zeros(len(observations), np.bool_)
        return self._shown((observations, nothing.astype(np.int32), nothing, nothing, info), mask)

    def _step(self, action: Any, env_id: Any) -> tuple[Any, Any, Any, Any, Info]:
        if self._is_new:
            return self._reset(None, None)
        return self._shown(self._envs.step(self._meant(action, env_id)))

    def _recv(self) -> tuple[Any, Any, Any, Any, Info]:
        return self._shown(self._envs.recv())

    def _meant(self, action: Any, env_id: Any) -> Any:
        if isinstance(action, dict):
            _check_parts(action)
            action, env_id = action["action"], action.get("env_id", action.get("players.env_id", env_id))
        if isinstance(action, np.ndarray) and action.dtype.kind == "f" and np.array_equal(action, np.floor(action)):
            action = action.astype(np.int64)
        if env_id is None:
            return action
        received, ids = self._envs.received, self._ids(env_id)
        order = np.argsort(ids)
        if not np.array_equal(ids[order], np.sort(received)):
            raise InvalidInput(f"env_id is {env_id!r}; it takes the environments that were received last: {received.tolist()}")
        return np.asarray(action)[order][np.searchsorted(ids[order], received)]

    def _ids(self, env_id: Any) -> npt.NDArray[np.integer[Any]]:
        """Numbers of environments, checked."""
        try:
            ids = np.atleast_1d(env_id)
        except ValueError:  # of rows of several lengths
            ids = np.empty(0)
        if ids.ndim != 1 or ids.dtype.kind not in "iu" or not np.isin(ids, self.all_env_ids).all():
            raise InvalidInput(f"env_id is {env_id!r}; it takes whole numbers from 0 to {self.num_envs - 1}, in one row")
        return ids

    def _shown(self, shown: tuple[Any, ...], mask: Any = None) -> tuple[Any, Any, Any, Any, Info]:
        observations, rewards, terminated, truncated, info = shown
        if observations.ndim == 5:
            observations = np.moveaxis(observations, -1, 2).reshape(len(observations), *self.observation_space.shape)
        chosen = slice(None) if mask is None else mask
        told = {key: {"env_id": info["env_id"][chosen]} if key == "players" else value[chosen] for key, value in info.items()}
        return (observations[chosen], rewards[chosen].astype(np.float32), (terminated & ~truncated)[chosen], truncated[chosen], told)


def _observations(config: dict[str, Any]) -> spaces.Box:
    """Of one environment. Colours are channels."""
    channels = config["stack_num"] * (1 if config["gray_scale"] else 3)
    return spaces.Box(0, 255, (channels, config["img_height"], config["img_width"]), np.uint8)


def _check_parts(action: dict[str, Any]) -> None:
    if "action" not in action:
        raise InvalidInput(f"the parts of the action are {', '.join(map(str, action))}; one must be 'action'")
    for name, part in action.items():
        if np.asarray(part).dtype != np.int32:
            raise InvalidInput(f"{name} of the action has the type {np.asarray(part).dtype}; it must be int32")


class GymnasiumEnvPool(_Pool, VectorEnv[Any, Any, Any], gymnasium.Env[Any, Any]):  # type: ignore[misc]
    """env_type="gymnasium"."""

    metadata = {"autoreset_mode": AutoresetMode.NEXT_STEP, "render_modes": ["rgb_array"]}

    def reset(self, env_id: Any = None, *, seed: Any = None, options: dict[str, Any] | None = None) -> tuple[Any, Info]:
        if seed is not None:
            self.seed(seed)
        observations, *_, info = self._reset(env_id, options)
        return observations, info

    def step(self, action: Any, env_id: Any = None) -> tuple[Any, Any, Any, Any, Info]:
        return self._step(action, env_id)

    def recv(self, reset: bool = False, return_info: bool = True) -> Any:
        observations, *rest, info = self._recv()
        return (observations, info) if flag("reset", reset) else (observations, *rest, info)


class GymEnvPool(_Pool):
    """env_type="gym": reset() returns observations, and a step has one end, `done`.

    To a program that has imported gym, the spaces are those of that package."""

    def __init__(self, task_id: str, config: dict[str, Any]) -> None:
        super().__init__(task_id, config)
        if "gym" in sys.modules:
            theirs, box, actions = sys.modules["gym"].spaces, self.single_observation_space, self.single_action_space
            assert isinstance(actions, spaces.Discrete)
            self.observation_space = self.single_observation_space = theirs.Box(0, 255, box.shape, box.dtype)
            self.action_space = self.single_action_space = theirs.Discrete(actions.n)

    def reset(self, env_id: Any = None) -> Any:
        return self._reset(env_id, None)[0]

    def step(self, action: Any, env_id: Any = None) -> tuple[Any, Any, Any, Info]:
        return self._joined(self._step(action, env_id))

    def recv(self, reset: bool = False, return_info: bool = True) -> Any:
        shown = self._recv()
        return shown[0] if flag("reset", reset) else self._joined(shown)

    @staticmethod
    def _joined(shown: tuple[Any, Any, Any, Any, Info]) -> tuple[Any, Any, Any, Info]:
        observations, rewards, terminated, truncated, info = shown
        return observations, rewards, terminated | truncated, {**info, "TimeLimit.truncated": truncated}


class State(NamedTuple):
    """The observation of a TimeStep."""

    env_id: Any
    players: Any
    obs: Any
    lives: Any
    reward: Any
    terminated: Any
    ram: Any


class TimeStep(NamedTuple):
    """As dm_env has it, for each environment: step_type is 0 for the first of an episode, 1, or 2 for the last."""

    step_type: npt.NDArray[np.int32]
    reward: npt.NDArray[np.float32]
    discount: npt.NDArray[np.float32]
    observation: State

    def first(self) -> Any:
        """Of which environments it is the first of an episode."""
        return self.step_type == 0

    def mid(self) -> Any:
        return self.step_type == 1

    def last(self) -> Any:
        return self.step_type == 2


class Players(NamedTuple):
    env_id: Any


class DmEnvPool(_Pool):
    """env_type="dm"."""

    def reset(self, env_id: Any = None) -> TimeStep:
        return self._time_step(self._reset(env_id, None))

    def step(self, action: Any, env_id: Any = None) -> TimeStep:
        return self._time_step(self._step(action, env_id))

    def recv(self, reset: bool = False, return_info: bool = True) -> TimeStep:
        return self._time_step(self._recv())

    def reward_spec(self) -> Any:
        """As dm_env has it, and EnvPool."""
        return dm_specs().Array((), float, "reward")

    def discount_spec(self) -> Any:
        """As dm_env has it, and EnvPool."""
        return dm_specs().BoundedArray((), float, 0.0, 1.0, "discount")

    def _time_step(self, shown: tuple[Any, Any, Any, Any, Info]) -> TimeStep:
        observations, rewards, terminated, truncated, info = shown
        done = terminated | truncated
        kinds = np.where(self._envs.began, 0, np.where(done, 2, 1)).astype(np.int32)
        ends = done | self._envs.lost if self.config["zero_discount_on_life_loss"] else done
        state = State(info["env_id"], Players(info["env_id"]), observations, info["lives"], info["reward"], info["terminated"], info["ram"])
        return TimeStep(kinds, rewards, (~ends).astype(np.float32), state)


def make_gymnasium(task_id: str, **config: Any) -> GymnasiumEnvPool:
    _check_info_wanted("gymnasium", config)
    return GymnasiumEnvPool(task_id, config)


def make_gym(task_id: str, **config: Any) -> GymEnvPool | GymnasiumEnvPool:
    return (GymnasiumEnvPool if flag("gym_reset_return_info", config.get("gym_reset_return_info")) else GymEnvPool)(task_id, config)


def make_dm(task_id: str, **config: Any) -> DmEnvPool:
    """It is a dm_env.Environment to a program that has imported dm_env."""
    if "dm_env" in sys.modules:
        sys.modules["dm_env"].Environment.register(DmEnvPool)
    _check_info_wanted("dm", config)
    return DmEnvPool(task_id, config)


def _check_info_wanted(env_type: str, config: Mapping[str, Any]) -> None:
    wanted = config.get("gym_reset_return_info")
    if wanted is not None and not flag("gym_reset_return_info", wanted):
        raise InvalidInput(f'gym_reset_return_info is {wanted!r}; with env_type="{env_type}" it takes True, and "gym" takes both')


MAKERS = {"gymnasium": make_gymnasium, "gym": make_gym, "dm": make_dm}


@overload
def make(task_id: str, env_type: Literal["gymnasium"], **config: Any) -> GymnasiumEnvPool: ...
@overload
def make(task_id: str, env_type: Literal["dm"], **config: Any) -> DmEnvPool: ...
@overload
def make(task_id: str, env_type: str, **config: Any) -> Any: ...
def make(task_id: str, env_type: str, **config: Any) -> Any:
    """Environments of the task, such as "Pong-v5". config: the settings of envpool_spec.CONFIG."""
    if env_type not in MAKERS:
        raise InvalidInput(f"env_type is {env_type!r}; it takes {', '.join(MAKERS)}")
    return MAKERS[env_type](task_id, **config)


def make_spec(task_id: str, **config: Any) -> EnvSpec:
    """The settings and the spaces of a task. Its image is needed for the number of actions."""
    whole = whole_config(task_id, config)
    game = ALEInterface()
    game.loadROM(images.find(_game(task_id)))
    actions = game.getLegalActionSet() if whole["full_action_space"] else game.getMinimalActionSet()
    return EnvSpec(whole, len(actions), _observations(whole))
