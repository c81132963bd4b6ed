"""Rollouts by actors on the nodes of a Ray cluster. Prints the total of rewards.

    python3 cluster/ray/rollouts.py breakout --actors 8 --rollouts 64 --roms /shared/atari

Each actor holds a vector environment. A rollout depends only on its number, so that the total is the same for any
number of actors and nodes. When a node is lost, its rollouts are repeated by the other actors.
"""

from __future__ import annotations

import argparse
import sys
from collections import deque
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import racebeam
import ray
from options import positive
from ray.exceptions import ObjectLostError, RayActorError, RayTaskError

Rollout = dict[str, np.ndarray]
Policy = Callable[[np.ndarray, np.random.Generator], np.ndarray]  # observations of all environments to actions


@ray.remote(num_cpus=1)
class Player:
    """An actor. `settings` are those of racebeam.AtariVectorEnv."""

    def __init__(self, game: str, num_envs: int, settings: dict[str, Any]) -> None:
        self.envs = racebeam.AtariVectorEnv(game, num_envs, num_threads=1, **settings)

    def play(self, seed: int, steps: int, policy: Policy | None) -> Rollout:
        """Returns arrays whose first axes are steps and environments. There is one more observation than steps.

        The environments write into the array of observations. Ray copies it once, into its object store, which readers
        on the same node map into their memory.
        """
        envs, chance = self.envs, np.random.default_rng(seed)
        observations = np.empty((steps + 1, *envs.observation_space.shape), np.uint8)
        actions = np.empty((steps, envs.num_envs), np.int64)
        rewards, done = np.empty(actions.shape, np.int32), np.empty(actions.shape, np.bool_)
        envs.reset(seed=seed, out=observations[0])
        for step in range(steps):
            actions[step] = (
                policy(observations[step], chance)
                if policy is not None
                else chance.integers(envs.single_action_space.n, size=envs.num_envs)
            )
            _, rewards[step], terminated, truncated, _ = envs.step(actions[step], out=observations[step + 1])
            done[step] = terminated | truncated
        return {"observations": observations, "actions": actions, "rewards": rewards, "done": done}


def result_of(reference: ray.ObjectRef) -> Any:
    """Returns the result of a call, or None if its node was lost. Raises what the actor raised."""
    try:
        return ray.get(reference)
    except (RayActorError, ObjectLostError) as error:
        if isinstance(error, RayActorError) and error.actor_init_failed:
            raise
        return None


def rollouts(
    game: str,
    *,
    actors: int,
    count: int,
    num_envs: int = 8,
    steps: int = 128,
    policy: Policy | None = None,
    **settings: Any,
) -> Iterator[Rollout]:
    """What `count` rollouts gave, those that end first first. Each begins with its own seeds.

    policy: None plays at random. The arrays of a rollout are read-only: they lie in the object store.
    """
    waiting, idle = deque(range(count)), []
    # The actor of each call without a result, and the number of its rollout; None if the actor is starting.
    calls: dict[ray.ObjectRef, tuple[Any, int | None]] = {}

    def start() -> None:
        actor = Player.remote(game, num_envs, settings)
        calls[actor.__ray_ready__.remote()] = actor, None

    for _ in range(actors):
        start()
    finished = 0
    while finished < count:
        (reference,), _ = ray.wait(list(calls))
        actor, number = calls.pop(reference)
        result = result_of(reference)
        if result is not None:
            idle.append(actor)
        else:
            start()  # in its place, once a processor is free
            if number is not None:
                waiting.appendleft(number)
        while idle and waiting:
            player, following = idle.pop(), waiting.popleft()
            calls[player.play.remote(following * num_envs, steps, policy)] = player, following
        if result is not None and number is not None:
            finished += 1
            yield result


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("game")
    parser.add_argument("--actors", type=positive, default=2)
    parser.add_argument("--rollouts", type=positive, default=8)
    parser.add_argument("--envs", type=positive, default=8, help="environments per actor")
    parser.add_argument("--steps", type=positive, default=128)
    parser.add_argument("--roms", help="the folder of cartridge images on each node")
    parser.add_argument("--address", help="address of a cluster, or auto; without it, Ray starts on this machine")
    options = parser.parse_args()
    images = {"RACEBEAM_ROMS": options.roms} if options.roms else {}
    ray.init(options.address, runtime_env={"env_vars": images})
    trajectories = rollouts(
        options.game, actors=options.actors, count=options.rollouts, num_envs=options.envs, steps=options.steps
    )
    try:
        print(sum(int(rollout["rewards"].sum()) for rollout in trajectories))
    except (RayActorError, RayTaskError) as error:  # its last line is what the environments raised
        sys.exit(f"rollouts.py: {str(error).rstrip().splitlines()[-1]}")


if __name__ == "__main__":
    main()
