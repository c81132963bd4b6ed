#!/usr/bin/env python3
"""PPO of Stable-Baselines3, in its settings for Atari, over racebeam's environments.

    pip install ".[sb3]"   # in the root of a clone
    python stable_baselines.py breakout

The line that racebeam changes is the one that makes the environments."""

import argparse
import sys

import racebeam.sb3
from stable_baselines3 import PPO


def main():
    """Reads the options, learns, and keeps what they say."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("game", nargs="?", default="beamfall", help="(default: %(default)s)")
    parser.add_argument("--steps", type=int, default=1_000_000, help="steps of all environments (default: %(default)s)")
    parser.add_argument(
        "--steps-of-update", type=int, default=128, help="steps of each environment per update (default: %(default)s)"
    )
    parser.add_argument("--envs", type=int, default=8, help="(default: %(default)s)")
    parser.add_argument("--seed", type=int, default=1, help="(default: %(default)s)")
    parser.add_argument("--model", metavar="FILE", help="the file for the model")
    parser.add_argument(
        "--log", metavar="FOLDER", help="a new folder for a submission of three games, which racebeam verify confirms"
    )
    parser.add_argument(
        "--preset", choices=("machado2018", "paper2013"), help="settings of the literature, for training and submission"
    )
    options = parser.parse_args()
    settings = {"preset": options.preset, "reward_clipping": True} if options.preset else {}

    # With Stable-Baselines3: VecFrameStack(make_atari_env("BeamfallNoFrameskip-v4", options.envs, options.seed), 4)
    try:
        envs = racebeam.sb3.VecEnv(options.game, options.envs, seed=options.seed, **settings)
    except racebeam.InvalidInput as error:
        sys.exit(f"stable_baselines.py: {error}")
    model = PPO(
        "CnnPolicy",
        envs,
        n_steps=options.steps_of_update,
        batch_size=256,
        n_epochs=4,
        learning_rate=2.5e-4,
        clip_range=0.1,
        ent_coef=0.01,
        seed=options.seed,
        verbose=1,
    )
    model.learn(options.steps)
    if options.model:
        model.save(options.model)
    if options.log:
        play_games(model, options)


def play_games(model, options):
    """Plays three games from power-on, and writes their logs, which anybody can confirm."""
    about = {
        "folder": options.log,
        "agent": "sb3-ppo",
        "agent_seed": options.seed,
        "training_frames": (5 if options.preset else 4) * options.steps,
    }
    ours = {
        "noop_max": 0,
        "use_fire_reset": False,
        "repeat_action_probability": 0.25,
        "max_num_frames_per_episode": 18000,
    }
    settings = {"preset": options.preset} if options.preset else ours
    envs = racebeam.AtariVectorEnv(options.game, seed=options.seed, log=about, **settings)
    games, (observations, _) = 0, envs.reset()
    while games < 3:
        actions, _ = model.predict(observations, deterministic=False)
        observations, _, terminated, truncated, _ = envs.step(actions)
        games += int((terminated | truncated).sum())
    envs.close()


if __name__ == "__main__":
    main()
