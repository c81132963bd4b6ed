"""AtariVectorEnv and ALEVectorInterface of ale_py."""

from __future__ import annotations

import functools
import operator
import os
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from .. import _core, vector_env, xla
from ..errors import InvalidInput
from ..vector.inputs import array_of, check_shape, seeds_of
from ..vector.machines import Actions, Joysticks, Seeds
from ..vector.results import Bools, Info, Numbers, Results, Step
from ..wire.action_words import STICK
from .interface import check_game, plain_errors
from .single import AtariEnv

__all__ = ["ALEVectorInterface", "AtariEnv", "AtariVectorEnv"]


class AtariVectorEnv(vector_env.AtariVectorEnv):
    """racebeam.AtariVectorEnv with the infos and the checks of ale_py.

    `info` has only `env_id`, `lives`, `frame_number` and `episode_frame_number`. With SAME_STEP, `final_obs` is one
    uint8 array of all environments. The first call must be a reset of all environments, and actions must be arrays of
    NumPy.

    Examples:
        >>> from racebeam.ale_py import AtariVectorEnv
        >>> envs = AtariVectorEnv("beamfall", 2)
        >>> observations, info = envs.reset(seed=1)
        >>> sorted(info)
        ['env_id', 'episode_frame_number', 'frame_number', 'lives']
        >>> envs.close()
    """

    _xla_infos = ("env_id", "lives", "frame_number", "episode_frame_number")
    is_xla_registered = False
    _was_reset = False
    _check_game = staticmethod(check_game)

    @functools.cached_property
    def map_action_idx(self) -> Numbers:
        """Number of the action of each position of a joystick.

        int32 array of shape (3, 3, 2): left to right, down to up, and without or with fire.
        """
        return np.ascontiguousarray(STICK.transpose(2, 1, 0), np.int32)

    @property
    def ale(self) -> ALEVectorInterface:
        """These environments, with the interface of lists and arrays."""
        return ALEVectorInterface.wrap(self)

    def reset(self, *, seed: Any = None, options: dict[str, Any] | None = None, out: Any = None) -> tuple[Any, Info]:
        """Begins new episodes, as racebeam.AtariVectorEnv does.

        Args:
            seed: One seed, or one for each environment that the mask chooses.
            options: May have "reset_mask".
            out: Array for the observations. Default: a new array.

        Returns:
            Observations and info.

        Raises:
            ValueError: If a seed, the mask or `out` has a wrong value or shape.
            RuntimeError: If the first reset is not of all environments.
        """
        return plain_errors(self._reset_as_ale, ValueError)(seed, options, out)

    def _reset_as_ale(self, seed: Any, options: dict[str, Any] | None, out: Any) -> tuple[Any, Info]:
        mask = self._parse_mask(options.get("reset_mask")) if isinstance(options, dict) else None
        if not (self._was_reset or mask is None or mask.all()):
            raise RuntimeError(
                f"reset_mask chooses {mask.sum()} of {self.num_envs}; the first reset() must reset every environment"
            )
        results = super().reset(seed=seed, options=options, out=out)
        self._was_reset = True
        return results

    def _parse_seeds(self, seed: Any, mask: Bools | None) -> Seeds | None:
        """Returns one seed for each environment: the given ones in the mask, and -1 elsewhere."""
        if seed is None or mask is None:
            return super()._parse_seeds(seed, mask)
        seeds = np.full(self.num_envs, -1, np.int64)
        seeds[mask] = seeds_of(seed, int(mask.sum()))
        return seeds

    def step(self, actions: Any, *, out: Any = None) -> Step:
        """Steps the environments, as racebeam.AtariVectorEnv does.

        Args:
            actions: int32 or int64 array of shape (n,); if `continuous`, float32 of shape (n, 3).
            out: Array for the observations. Default: a new array.

        Returns:
            Observations, rewards (int32), terminated (bool), truncated (bool) and info.

        Raises:
            AssertionError: If the actions have another dtype or shape.
            IndexError: If an action is out of range.
            RuntimeError: Before the first reset.
        """
        self._check_reset()
        return super().step(actions, out=out)

    def send(self, actions: Any) -> None:
        """Begins a step of the environments that the last call returned.

        Args:
            actions: As in `step`.

        Raises:
            AssertionError: If the actions have another dtype or shape.
            IndexError: If an action is out of range.
            RuntimeError: Before the first reset.
        """
        self._check_reset()
        super().send(actions)

    def _check_reset(self) -> None:
        self._check_open()
        if not self._was_reset:
            raise RuntimeError("these environments have not been reset yet; call reset() first")

    def xla(self) -> tuple[Any, Callable[..., Any], Callable[..., Any]]:
        """Makes functions that programs compiled by JAX call, as racebeam.AtariVectorEnv does."""
        functions = super().xla()
        self.is_xla_registered = self._was_reset = True
        return functions

    def action_numbers(self) -> list[int]:
        """Returns the numbers of the actions, in the order of the indices that `step` takes."""
        return self._open_machines().actions_of(0)

    def send_strengths(self, actions: Any, strengths: Any) -> None:
        """Begins a step with the strengths of paddles.

        Args:
            actions: Integers of shape (n,).
            strengths: Numbers of shape (n,): how far each paddle is turned; 1 is the usual step.

        Raises:
            TypeError: If the actions or the strengths have a wrong type.
            IndexError: If an action is out of range.
            InvalidInput: If the actions or the strengths have a wrong shape.
            RuntimeError: Before the first reset.
        """
        self._check_reset()
        turned = array_of(strengths)
        if turned.dtype.kind not in "fiu":
            raise TypeError(f"paddle strengths have the type {turned.dtype}; they must be numbers")
        check_shape("paddle strengths", turned, (self.batch_size,))
        parsed = vector_env.AtariVectorEnv._parse_actions(self, actions)
        self._open_machines().send_strengths(parsed, turned.astype(np.float32), self._last_received())

    def _parse_actions(self, actions: Any, count: int | None = None) -> Actions:
        assert isinstance(actions, np.ndarray) and actions.dtype in (np.int32, np.int64), (
            f"actions are {actions!r}; they must be an array of int32 or int64"
        )
        assert actions.shape == (self.batch_size,), (
            f"actions have the shape {actions.shape}; they must have {(self.batch_size,)}"
        )
        return super()._parse_actions(actions, count)

    def _parse_joysticks(self, actions: Any) -> Joysticks:
        assert isinstance(actions, np.ndarray) and actions.dtype == np.float32, (
            f"actions are {actions!r}; they must be an array of float32"
        )
        assert actions.shape == (self.batch_size, 3), (
            f"actions have the shape {actions.shape}; they must have {(self.batch_size, 3)}"
        )
        return super()._parse_joysticks(actions)

    def _make_info(self, results: Results) -> Info:
        return {
            "env_id": results.env_id,
            "lives": results.lives,
            "frame_number": results.frames,
            "episode_frame_number": results.episode_frames,
        }

    def _add_finals(self, info: Info, observations: Any, results: Results) -> None:
        """Adds `final_obs`, one array. Where no episode ended, it has the present observation."""
        goes_on = ~results.finished
        for final, present in (
            (results.final_observations, results.ram if self._shows_ram else results.observations),
            (results.final_sound, results.sound),
        ):
            if final is not None and present is not None:
                final[goes_on] = present[goes_on]
        info["final_obs"] = self._final_observations(results)


class ALEVectorInterface:
    """Many environments of one game, whose calls take and return lists and arrays.

    Args:
        rom_path: Path of the image, or "builtin:NAME".
        num_envs: Number of environments.
        frame_skip: Frames per step.
        stack_num: Screens in an observation.
        img_height: Rows of an observation.
        img_width: Columns of an observation.
        grayscale: Whether observations are shades of grey.
        maxpool: Whether a screen is the pixelwise maximum of the last two frames of a step.
        noop_max: Upper limit of the random number of NOOP frames that begin an episode.
        use_fire_reset: Whether an episode begins with FIRE.
        episodic_life: Whether a lost life ends the episode, and restarts the game.
        life_loss_info: Whether a lost life terminates the step, and the episode continues.
        reward_clipping: Whether rewards are clipped to [-1, 1].
        max_episode_steps: Frames after which an episode is truncated, as in ale_py; 0 for no limit.
        repeat_action_probability: Probability that a frame repeats the previous action.
        full_action_space: Whether actions are all 18 legal ones.
        batch_size: Number of environments that `recv` waits for; 0 for all.
        num_threads: Number of threads; 0 for one per processor.
        thread_affinity_offset: First processor to which threads are bound; -1 does not bind them.
        autoreset_mode: "NextStep", "SameStep" or "Disabled".

    Raises:
        ValueError: If an argument is wrong, or the image is unknown.

    Examples:
        >>> from racebeam.ale_py import ALEVectorInterface
        >>> ale = ALEVectorInterface("builtin:beamfall", 2)
        >>> observations, info = ale.reset([0, 1], [7, 8])
        >>> observations.shape
        (2, 4, 84, 84)
    """

    def __init__(
        self,
        rom_path: str | os.PathLike[str],
        num_envs: int,
        frame_skip: int = 4,
        stack_num: int = 4,
        img_height: int = 84,
        img_width: int = 84,
        grayscale: bool = True,
        maxpool: bool = True,
        noop_max: int = 30,
        use_fire_reset: bool = True,
        episodic_life: bool = False,
        life_loss_info: bool = False,
        reward_clipping: bool = True,
        max_episode_steps: int = 108000,
        repeat_action_probability: float = 0.0,
        full_action_space: bool = False,
        batch_size: int = 0,
        num_threads: int = 0,
        thread_affinity_offset: int = -1,
        autoreset_mode: str = "NextStep",
    ) -> None:
        md5, game = _core.identify(rom_path)
        if game is None:
            raise InvalidInput(f"image {os.fspath(rom_path)} has the MD5 {md5}, which no known game has")
        self._envs = AtariVectorEnv(
            game,
            num_envs,
            rom=rom_path,
            frameskip=frame_skip,
            stack_num=stack_num,
            img_height=img_height,
            img_width=img_width,
            grayscale=grayscale,
            maxpool=maxpool,
            noop_max=noop_max,
            use_fire_reset=use_fire_reset,
            episodic_life=episodic_life,
            life_loss_info=life_loss_info,
            reward_clipping=reward_clipping,
            max_num_frames_per_episode=max_episode_steps,
            repeat_action_probability=repeat_action_probability,
            full_action_space=full_action_space,
            batch_size=batch_size,
            num_threads=num_threads,
            thread_affinity_offset=thread_affinity_offset,
            autoreset_mode=autoreset_mode,
        )

    @classmethod
    def wrap(cls, envs: AtariVectorEnv) -> ALEVectorInterface:
        """Makes the interface of existing environments.

        Args:
            envs: The environments.

        Returns:
            The interface, which shares them.
        """
        interface = cls.__new__(cls)
        interface._envs = envs
        return interface

    def reset(self, env_ids: Sequence[int], seeds: Sequence[int], /) -> tuple[Any, dict[str, Any]]:
        """Begins new episodes of some environments.

        Args:
            env_ids: Indices of the environments, each once.
            seeds: A seed for each of them; -1 means unseeded.

        Returns:
            Observations and info of all environments, or of the first `batch_size` that finish.

        Raises:
            IndexError: If an index is out of range.
            ValueError: If an index occurs twice, or the numbers of indices and seeds differ.
        """
        count, ids = self._envs.num_envs, [operator.index(env) for env in env_ids]
        if len(ids) != len(seeds):
            raise ValueError(f"there are {len(seeds)} seeds for {len(ids)} environments")
        for env in ids:
            if not 0 <= env < count:
                raise IndexError(f"environment {env} is out of range; accepted: 0 to {count - 1}")
        if len(set(ids)) < len(ids):
            raise ValueError(f"there is a duplicate env_id in {ids}; each is reset once")
        every = np.full(count, -1, np.int64)
        every[ids] = [operator.index(seed) for seed in seeds]
        selection = np.isin(np.arange(count), ids)
        return self._envs.reset(seed=every[selection], options=None if selection.all() else {"reset_mask": selection})

    def send(self, action_ids: Sequence[int], paddle_strengths: Sequence[float], /) -> None:
        """Begins a step of the environments that were received last.

        Args:
            action_ids: An index into `get_action_set()` for each environment.
            paddle_strengths: How far each paddle is turned; 1 is the usual step.

        Raises:
            IndexError: If an action is out of range.
            TypeError: If the actions or the strengths have a wrong type.
            ValueError: If their numbers are wrong.
        """
        plain_errors(self._envs.send_strengths, ValueError)(action_ids, paddle_strengths)

    def recv(self) -> tuple[Any, Any, Any, Any, dict[str, Any]]:
        """Waits for the first `batch_size` environments that finish.

        Returns:
            Observations, rewards, terminated, truncated and info.
        """
        return self._envs.recv()

    def get_action_set(self) -> list[_core.Action]:
        """Returns the actions of the game."""
        return [_core.Action(number) for number in self._envs.action_numbers()]

    def get_num_envs(self) -> int:
        """Returns the number of environments."""
        return self._envs.num_envs

    def get_observation_shape(self) -> tuple[int, ...]:
        """Returns the shape of the observation of one environment."""
        return self._envs.single_observation_space.shape or ()

    def handle(self) -> npt.NDArray[np.uint8]:
        """Returns the handle that names the environments in custom calls of XLA, uint8 of shape (8,)."""
        return xla.handle_of(self._envs)
