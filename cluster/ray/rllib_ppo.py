"""PPO of Ray's RLlib on the RAM of a game. Prints the mean return of each iteration.

    pip install ".[rllib]"   # in the root of a clone
    python3 cluster/ray/rllib_ppo.py Breakout --iterations 100 --runners 8

The vector entry point of the id makes one racebeam.AtariVectorEnv in each runner. With --single, a runner has a
racebeam.AtariEnv for each environment.
"""

from __future__ import annotations

import argparse
import sys
from typing import Any

import gymnasium
import numpy as np
import racebeam  # noqa: F401  # it registers its environments
from options import positive
from ray.rllib.algorithms.ppo import PPOConfig
from ray.rllib.connectors.env_to_module.observation_preprocessor import SingleAgentObservationPreprocessor


class Scaled(SingleAgentObservationPreprocessor):
    """Bytes of an observation as numbers from 0 to 1."""

    def recompute_output_observation_space(
        self, input_observation_space: gymnasium.Space, _: gymnasium.Space
    ) -> gymnasium.Space:
        return gymnasium.spaces.Box(0, 1, input_observation_space.shape, np.float32)

    def preprocess(self, observation: np.ndarray, episode: Any) -> np.ndarray:
        return observation.astype(np.float32) / 255


def config(game: str, *, runners: int = 1, envs: int = 8, vector: bool = True, **settings: Any) -> PPOConfig:
    """settings: of racebeam.AtariVectorEnv or, without `vector`, of racebeam.AtariEnv."""
    return (
        PPOConfig()
        .environment(f"racebeam:racebeam/{game}-v5", env_config={"obs_type": "ram", **settings})
        .env_runners(
            num_env_runners=runners,
            num_envs_per_env_runner=envs,
            gym_env_vectorize_mode="vector_entry_point" if vector else "sync",
            env_to_module_connector=lambda env, spaces, device: Scaled(),
        )
        .training(train_batch_size_per_learner=1024, minibatch_size=256, num_epochs=4)
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("game", help="name of the game, as in the id racebeam/Breakout-v5")
    parser.add_argument("--iterations", type=positive, default=10)
    parser.add_argument("--runners", type=positive, default=1)
    parser.add_argument("--envs", type=positive, default=8, help="environments per runner")
    parser.add_argument("--single", action="store_true", help="without vector environments")
    options = parser.parse_args()
    try:
        gymnasium.spec(f"racebeam/{options.game}-v5")
    except gymnasium.error.Error as error:
        sys.exit(f"rllib_ppo.py: {error}")
    algorithm = config(options.game, runners=options.runners, envs=options.envs, vector=not options.single).build_algo()
    for iteration in range(options.iterations):
        print(iteration, algorithm.train()["env_runners"].get("episode_return_mean"), flush=True)
    algorithm.stop()


if __name__ == "__main__":
    main()
