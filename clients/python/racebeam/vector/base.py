"""The base of vectors of environments: spaces, results, the window, and closing."""

from __future__ import annotations

from typing import Any

import numpy as np
from gymnasium import error, spaces
from gymnasium.vector.utils import batch_space

from .. import images
from ..errors import InvalidInput
from ..single.window import Grid
from ..vector_options import VectorOptions, autoreset_of
from ..wire.remote_machines import RemoteMachines
from ..wire.spread_machines import SpreadMachines
from .autoreset import AutoresetMode, VectorEnv
from .machines import Machines
from .results import Info, Numbers, Pixels, Results, Step

__all__ = ["VectorBase"]

RAM_SIZE, SOUND_SIZE, SCREEN_WIDTH = 128, 512, 160


class VectorBase(VectorEnv[Any, Any, Any]):
    """Base class of vectors of environments. A subclass calls `_use` in its constructor.

    Examples:
        >>> import racebeam
        >>> from racebeam.vector.base import VectorBase
        >>> isinstance(racebeam.AtariVectorEnv("beamfall", 2), VectorBase)
        True
    """

    metadata: dict[str, Any] = {"render_modes": ["human", "rgb_array"], "render_fps": 15}
    _first_seed: int | None = None

    def _use(
        self,
        machines: Machines,
        names: list[str | None],
        game_of_env: Numbers,
        options: VectorOptions,
        first_seed: int | None = None,
    ) -> None:
        """Sets the attributes, for machines that were made with these options.

        Args:
            machines: The machines.
            names: Names of the games.
            game_of_env: For each environment, the index of its game.
            options: The options.
            first_seed: Seed of the first reset. It is not used if something is played before.
        """
        self._first_seed = first_seed
        self._machines: Any = machines
        self._options = options
        self._games = [names[index] for index in game_of_env]
        self.num_envs = options.num_envs
        self.batch_size: int = options.batch_size
        self.autoreset_mode = autoreset_of(options.autoreset_mode)
        self.metadata = {**type(self).metadata, "autoreset_mode": self.autoreset_mode}
        self.render_mode = options.render_mode
        self.grayscale: bool = not options.is_rgb
        self.continuous = options.continuous
        self.continuous_action_threshold = options.continuous_action_threshold
        self.sound_obs = options.sound_obs
        self._shows_ram = options.obs_type == "ram"
        self._has_finals = self.autoreset_mode is AutoresetMode.SAME_STEP
        self._received_ids = np.arange(self.num_envs, dtype=np.int32)
        self._make_spaces()
        self._window: Grid | None = None
        if self.render_mode == "human":
            title = images.titles().get(str(names[0]), "racebeam") if len(names) == 1 else "racebeam"
            self._window = Grid(title, self.num_envs, SCREEN_WIDTH, self._machines.height())

    def __repr__(self) -> str:
        game = self._games[0] if len(set(self._games)) == 1 else self._games
        return f"{type(self).__name__}(game={game!r}, num_envs={self.num_envs})"

    # Spaces

    def _make_spaces(self) -> None:
        self._shape = self._shape_of_images()
        self.single_observation_space: spaces.Space[Any] = spaces.Box(0, 255, self._shape, np.uint8)
        if self.sound_obs:
            sound = spaces.Box(0, 255, (self._samples(),), np.uint8)
            self.single_observation_space = spaces.Dict({"image": self.single_observation_space, "sound": sound})
        self.single_action_space = self._space_of_actions()
        self.observation_space = batch_space(self.single_observation_space, self.batch_size)
        self.action_space = batch_space(self.single_action_space, self.batch_size)

    def _samples(self) -> int:
        return SOUND_SIZE * (self._options.frameskip if self.sound_obs == "all" else 1)

    def _shape_of_images(self) -> tuple[int, ...]:
        if self._shows_ram:
            return (RAM_SIZE,)
        settings = self._options._core_settings()
        shape = (settings.stack, settings.height or self._machines.height(), settings.width or SCREEN_WIDTH)
        return shape if self.grayscale else (*shape, 3)

    def _space_of_actions(self) -> spaces.Space[Any]:
        counts = sorted(set(self._machines.numbers_of_actions()))
        if self.continuous:
            low, high = np.array([0, -np.pi, 0], np.float32), np.array([1, np.pi, 1], np.float32)
            return spaces.Box(low, high, dtype=np.float32)
        if len(counts) == 1:
            return spaces.Discrete(counts[0])
        raise InvalidInput(
            f"the games have {' and '.join(map(str, counts))} actions; full_action_space=True gives them the same"
        )

    # Results

    def _allocate_results(self, out: Pixels | None, count: int | None = None) -> Results:
        """Allocates results for `count` environments. Default: for a batch."""
        count = self.batch_size if count is None else count
        shape = (count, *self._shape)
        if out is None:
            out = np.empty(shape, np.uint8)
        elif not (isinstance(out, np.ndarray) and out.dtype == np.uint8 and out.shape == shape and out.flags.carray):
            raise InvalidInput(
                f"out is {_describe(out)}; it takes a writable, contiguous array of uint8 with the shape {shape}"
            )
        finals = np.empty(shape, np.uint8) if self._has_finals else None
        observations, ram = (None, out) if self._shows_ram else (out, None)
        results = Results.allocate(observations, ram, count, finals)
        if not self.sound_obs:
            return results
        sound, final_sound = np.empty((2, count, self._samples()), np.uint8)
        return results._replace(sound=sound, final_sound=final_sound if self._has_finals else None)

    def _observations(self, results: Results) -> Any:
        image = results.ram if self._shows_ram else results.observations
        return {"image": image, "sound": results.sound} if self.sound_obs else image

    def _final_observations(self, results: Results) -> Any:
        image = results.final_observations
        return {"image": image, "sound": results.final_sound} if self.sound_obs else image

    def _format_step(self, results: Results) -> Step:
        self._received_ids = results.env_id.copy()
        self._show_window()
        observations, info = self._observations(results), self._make_info(results)
        if self._has_finals and results.finished.any():
            self._add_finals(info, observations, results)
        return observations, results.rewards, results.terminated, results.truncated, info

    def _make_info(self, results: Results) -> Info:
        losses = {"lost": self._machines.lost} if isinstance(self._machines, SpreadMachines) else {}
        return {
            "env_id": results.env_id,
            "lives": results.lives,
            "frame_number": results.frames,
            "episode_frame_number": results.episode_frames,
            "raw_reward": results.raw_rewards,
            "game_over": results.game_over,
            **losses,
        }

    def _add_finals(self, info: Info, observations: Any, results: Results) -> None:
        """Adds the keys of SAME_STEP as Gymnasium defines them: arrays of objects, None where no episode ended."""
        finished, finals = results.finished, self._final_observations(results)
        assert results.final_numbers is not None
        objects = np.empty(self.batch_size, object)
        for env in np.flatnonzero(finished):
            objects[env] = row_of(finals, int(env))
        numbers = np.where(finished, results.final_numbers, 0)
        finals_by_name = dict(zip(("lives", "frame_number", "episode_frame_number"), numbers, strict=True))
        info["final_obs"], info["_final_obs"] = objects, finished
        info["final_info"], info["_final_info"] = (
            {**finals_by_name, **{f"_{key}": finished for key in finals_by_name}},
            finished,
        )

    def _show_window(self) -> None:
        """Shows the environments that the last call returned."""
        if self._window is not None:
            visible = (int(env) for env in self._received_ids if self._window.shows(int(env)))
            self._window.show(((env, self._machines.screen(env)) for env in visible), self._options.frameskip)

    # The end

    def __enter__(self) -> Any:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __reduce__(self) -> tuple[Any, ...]:
        raise TypeError(
            f"{type(self).__name__} cannot be pickled or copied, because it owns threads; make another one with the "
            "same arguments, and restore() the states that save() returns, which can be pickled"
        )

    def close_extras(self, **kwargs: Any) -> None:
        """Stops the threads or ends the sessions, and frees the memory. `close` calls it.

        Args:
            **kwargs: Ignored.
        """
        machines = self.__dict__.get("_machines")  # missing if the constructor failed
        window = self.__dict__.get("_window")
        self._machines, self._window = _Closed(), None
        if window is not None:
            window.close()
        if isinstance(machines, (RemoteMachines, SpreadMachines)):
            machines.close()

    def _check_open(self) -> None:
        if self.closed:
            raise _closed_error()


class _Closed:
    """Placeholder for closed machines: any use raises ClosedEnvironmentError, also in the call of another thread."""

    def __getattr__(self, name: str) -> Any:
        raise _closed_error()


def _closed_error() -> error.ClosedEnvironmentError:
    return error.ClosedEnvironmentError("these environments were closed; make new ones")


def _describe(out: object) -> str:
    """Returns what an argument is, for a message."""
    if not isinstance(out, np.ndarray):
        return f"of type {type(out).__name__}"
    faults = "" if out.flags.writeable else ", read-only", "" if out.flags.c_contiguous else ", not contiguous"
    return f"an array of {out.dtype} with the shape {out.shape}{''.join(faults)}"


def row_of(observations: Any, env: int) -> Any:
    """Copies the observation of one environment.

    Args:
        observations: An array, or a dict of arrays, with a row for each environment.
        env: Index of the row.

    Returns:
        The row, or a dict of rows.
    """
    if isinstance(observations, dict):
        return {name: part[env].copy() for name, part in observations.items()}
    return observations[env].copy()
