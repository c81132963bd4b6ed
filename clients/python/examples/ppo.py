#!/usr/bin/env python3
"""PPO (Schulman et al. 2017) in JAX, on RAM or on pixels, over racebeam's vector environment.

    pip install ".[jax]" optax matplotlib tqdm   # in the root of a clone
    python ppo.py updraft --curve ppo.png --keep updraft.npz
    python ppo.py updraft --play updraft.npz --film updraft.gif --log updraft.episode
    racebeam verify updraft.episode

A lost life ends an episode for the agent, and the game goes on. Rewards are clipped to -1..1, and scores are those of
the game. With the same seed and processor, it learns the same.
"""

import argparse
import datetime
import functools
import sys
import time
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
import optax
import racebeam
from tqdm import tqdm

DISCOUNT, GAE_DECAY = 0.99, 0.95  # gamma, lambda
CLIP, ENTROPY, VALUE = 0.1, 0.01, 0.5
LONGEST_GRADIENT = 0.5
FRAME_SKIP = 4  # frames of a step
LONGEST_GAME = 108000  # frames
GAMES_OF_MEAN = 20  # games in a mean of the curve, and of its baseline
CONVOLUTIONS = ((32, 8, 4), (64, 4, 2), (64, 3, 1))  # channels, size and stride, as in DQN


class Batch(NamedTuple):
    """The steps of a batch: a row for each step of each environment."""

    observations: np.ndarray
    actions: np.ndarray
    log_probabilities: np.ndarray
    advantages: np.ndarray
    returns: np.ndarray


def layer(key, shape, scale):
    """Makes the parameters of a layer: orthogonal weights of this scale, and a bias of 0."""
    return {"weights": jax.nn.initializers.orthogonal(scale)(key, shape), "bias": jnp.zeros(shape[-1])}


def network(key, shape, actions):
    """Makes the parameters for observations of this shape: 128 bytes of RAM, or screens x height x width."""
    keys = iter(jax.random.split(key, 8))
    if len(shape) == 1:
        body, size = [layer(next(keys), (8 * shape[0], 256), 2**0.5), layer(next(keys), (256, 256), 2**0.5)], 256
    else:
        body, (depth, height, width) = [], shape
        for channels, side, stride in CONVOLUTIONS:
            body.append(layer(next(keys), (side, side, depth, channels), 2**0.5))
            height, width, depth = (height - side) // stride + 1, (width - side) // stride + 1, channels
        body.append(layer(next(keys), (height * width * depth, 512), 2**0.5))
        size = 512
    return {
        "body": body,
        "policy": layer(next(keys), (size, actions), 0.01),
        "value": layer(next(keys), (size, 1), 1.0),
    }


def forward(parameters, observations):
    """Returns the logits of the actions, and the values of the observations."""
    *convolutions, last = parameters["body"]
    if observations.ndim == 2:  # RAM, bit by bit
        bits = observations[:, :, None] >> jnp.arange(8, dtype=jnp.uint8) & 1
        hidden = jax.nn.relu(dense(convolutions[0], bits.reshape(len(bits), -1).astype(jnp.float32)))
    else:
        hidden = observations.transpose(0, 2, 3, 1).astype(jnp.float32) / 255
        for (_, _, stride), one in zip(CONVOLUTIONS, convolutions):
            hidden = jax.lax.conv_general_dilated(
                hidden, one["weights"], (stride, stride), "VALID", dimension_numbers=("NHWC", "HWIO", "NHWC")
            )
            hidden = jax.nn.relu(hidden + one["bias"])
        hidden = hidden.reshape(len(hidden), -1)
    hidden = jax.nn.relu(dense(last, hidden))
    return dense(parameters["policy"], hidden), dense(parameters["value"], hidden)[:, 0]


def dense(one, hidden):
    """Applies a layer to the outputs of the one before it."""
    return hidden @ one["weights"] + one["bias"]


@jax.jit
def choose(parameters, observations, key):
    """Draws actions. Returns them, their log probabilities, and the values of the observations."""
    logits, values = forward(parameters, observations)
    actions = jax.random.categorical(key, logits)
    return actions, log_probabilities_of(logits, actions), values


def log_probabilities_of(logits, actions):
    """Returns the log probability of each action."""
    return jnp.take_along_axis(jax.nn.log_softmax(logits), actions[:, None], axis=1)[:, 0]


def loss(parameters, batch):
    """Returns what an update minimises: the losses of the policy and of the values, less the entropy."""
    logits, values = forward(parameters, batch.observations)
    ratios = jnp.exp(log_probabilities_of(logits, batch.actions) - batch.log_probabilities)
    advantages = (batch.advantages - batch.advantages.mean()) / (batch.advantages.std() + 1e-8)
    gain = jnp.minimum(ratios * advantages, jnp.clip(ratios, 1 - CLIP, 1 + CLIP) * advantages).mean()
    entropy = -(jax.nn.softmax(logits) * jax.nn.log_softmax(logits)).sum(axis=1).mean()
    return -gain - ENTROPY * entropy + VALUE * 0.5 * ((values - batch.returns) ** 2).mean()


@functools.partial(jax.jit, static_argnames=("optimizer", "epochs", "parts"))
def update(parameters, state, batch, key, optimizer, epochs, parts):
    """Goes over the batch several times, in a random order and in parts. Returns the new parameters and state."""
    count = len(batch.actions)
    order = jnp.concatenate([jax.random.permutation(one, count) for one in jax.random.split(key, epochs)])

    def learn(carried, chosen):
        parameters, state = carried
        gradient = jax.grad(loss)(parameters, jax.tree.map(lambda values: values[chosen], batch))
        change, state = optimizer.update(gradient, state)
        return (optax.apply_updates(parameters, change), state), None

    (parameters, state), _ = jax.lax.scan(learn, (parameters, state), order.reshape(epochs * parts, -1))
    return parameters, state


def advantages_of(rewards, values, ends, last_values):
    """Estimates advantages (GAE). Row t of `ends` says in which environments step t ended an episode."""
    advantages, following, next_values = np.zeros_like(rewards), np.zeros_like(last_values), last_values
    for step in reversed(range(len(rewards))):
        goes_on = 1 - ends[step]
        error = rewards[step] + DISCOUNT * goes_on * next_values - values[step]
        advantages[step] = following = error + DISCOUNT * GAE_DECAY * goes_on * following
        next_values = values[step]
    return advantages


def make_envs(options, count, **arguments):
    """Makes `count` environments of the game, with the observations that the options say."""
    view = {"obs_type": "ram"} if options.observe == "ram" else {}
    return racebeam.AtariVectorEnv(
        options.game,
        count,
        seed=options.seed,
        frameskip=FRAME_SKIP,
        max_num_frames_per_episode=LONGEST_GAME,
        **view,
        **arguments,
    )


class Player:
    """Plays the environments, and keeps the scores of whole games."""

    def __init__(self, options, **arguments):
        self.envs = make_envs(
            options, options.envs, life_loss="end", autoreset_mode="SameStep", server=options.server, **arguments
        )
        self.observations, _ = self.envs.reset()
        self.sums, self.scores, self.seconds = np.zeros(options.envs, np.int64), [], 0.0

    def network(self, key):
        """Makes the parameters for these environments."""
        return network(key, self.envs.single_observation_space.shape, int(self.envs.single_action_space.n))

    def play(self, parameters, key, steps):
        """Plays this number of steps in each environment. Returns the batch."""
        rows = []
        for one in jax.random.split(key, steps):
            observations = self.observations
            actions, log_probabilities, values = map(np.asarray, choose(parameters, observations, one))
            rows.append((observations, actions, log_probabilities, values, *self.step(actions)))
        observations, actions, log_probabilities, values, rewards, ends = map(np.stack, zip(*rows))
        _, _, last_values = choose(parameters, self.observations, key)
        advantages = advantages_of(rewards, values, ends, np.asarray(last_values))
        flat = (observations, actions, log_probabilities, advantages, advantages + values)
        return Batch(*(part.reshape(-1, *part.shape[2:]) for part in flat))

    def step(self, actions):
        """Steps the environments, and counts scores and time. Returns the rewards and the ends."""
        began = time.perf_counter()
        self.observations, rewards, terminated, truncated, info = self.envs.step(actions)
        self.seconds += time.perf_counter() - began
        self.sums += info["raw_reward"]
        self.over = info["game_over"] | truncated
        self.scores += self.sums[self.over].tolist()
        self.sums[self.over] = 0
        return rewards.astype(np.float32), (terminated | truncated).astype(np.float32)


def keep(path, parameters):
    """Writes the parameters of a policy into a file."""
    with open(path, "wb") as file:
        np.savez(file, *jax.tree.leaves(parameters))


def restore(path, parameters):
    """Reads parameters of the same shapes from a file that keep() wrote."""
    leaves, tree = jax.tree.flatten(parameters)
    with np.load(path) as file:
        arrays = [file[f"arr_{index}"] for index in range(len(file.files))]
    if [one.shape for one in arrays] != [one.shape for one in leaves]:
        raise ValueError(f"{path} has a policy for another game, or for another --observe")
    return jax.tree.unflatten(tree, arrays)


def play_games(options, parameters):
    """Plays with a policy, without learning. The film has the first game of the first environment."""
    player = Player(options, render_mode="rgb_array" if options.film else None)
    key, frames, filming = jax.random.key(options.seed), [], bool(options.film)
    while len(player.scores) < options.games or filming:
        key, one = jax.random.split(key)
        frames += player.envs.render()[:1] if filming else ()
        player.step(np.asarray(choose(parameters, player.observations, one)[0]))
        filming = filming and not player.over[0]
    scores = player.scores[: options.games]
    print(f"{len(scores)} games: mean score {np.mean(scores):.1f}, from {min(scores)} to {max(scores)}")
    if frames:
        film(options.film, frames)


def log_game(options, parameters):
    """Plays one game with a policy, from power-on and without random no-ops, and writes its log."""
    from racebeam.episode_log import write_log

    envs = make_envs(options, 1, noop_max=0, use_fire_reset=False, autoreset_mode="Disabled")
    numbers = [racebeam.Action[name].value for name in envs.get_action_meanings()]
    (observations, _), key = envs.reset(), jax.random.key(options.seed)
    actions, is_over = [], False
    while not is_over:
        key, one = jax.random.split(key)
        action = np.asarray(choose(parameters, observations, one)[0])
        actions.append(numbers[action[0]])
        observations, _, terminated, truncated, _ = envs.step(action)
        is_over = terminated[0] or truncated[0]
    how = {"seed": options.seed, "frame_skip": FRAME_SKIP, "max_episode_frames": LONGEST_GAME}
    episode = write_log(options.log, options.game, actions, **how, agent="ppo", agent_seed=options.seed)
    print(f"{options.log}: score {episode.score} in {episode.frames:,} frames; racebeam verify confirms it")


def film(path, frames):
    """Writes screens as an animated GIF, in the proportions of a television."""
    from PIL import Image

    height, width, _ = frames[0].shape
    images = [Image.fromarray(frame).resize((2 * width, height)) for frame in frames]
    images[0].save(path, save_all=True, append_images=images[1:], duration=1000 * FRAME_SKIP // 60, loop=0)


def seconds_per_update(options, parameters, optimizer):
    """Measures an update in other environments. The one before it compiles the functions, and is not measured."""
    player, key, state = Player(options), jax.random.key(0), optimizer.init(parameters)
    for _ in range(2):
        began = time.perf_counter()
        batch = player.play(parameters, key, options.horizon)
        jax.block_until_ready(update(parameters, state, batch, key, optimizer, options.epochs, options.parts))
    player.envs.close()
    return time.perf_counter() - began


def random_score(options):
    """Plays games with random actions. Returns their mean score, the baseline of the curve."""
    player, random = Player(options), np.random.default_rng(options.seed)
    while len(player.scores) < max(GAMES_OF_MEAN, 4 * options.envs):  # short games end first
        player.step(random.integers(player.envs.single_action_space.n, size=options.envs))
    return float(np.mean(player.scores))


def draw(path, points, baseline, title):
    """Draws the curve, with the score of random play as a line."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    _, axes = pyplot.subplots(figsize=(7, 4.5), layout="constrained")
    axes.plot(*zip(*points), marker=".", label=f"mean of the last {GAMES_OF_MEAN} games")
    axes.axhline(baseline, color="grey", linestyle="--", label=f"random play: {baseline:.1f}")
    axes.set(title=title, xlabel="steps of all environments", ylabel="score of a game")
    axes.set_xlim(0)
    axes.set_ylim(min(0, baseline, *(score for _, score in points)))
    axes.xaxis.set_major_formatter("{x:,.0f}")
    axes.yaxis.set_major_formatter("{x:,.0f}")
    axes.grid(alpha=0.3)
    axes.legend()
    pyplot.savefig(path, dpi=120)


def learn(options, player, parameters, key):
    """Learns for as many steps as the options say. Returns the parameters."""
    steps = options.envs * options.horizon
    updates = options.steps // steps
    rate = optax.linear_schedule(options.rate, 0, updates * options.epochs * options.parts)
    optimizer = optax.chain(optax.clip_by_global_norm(LONGEST_GRADIENT), optax.adam(rate, eps=1e-5))
    estimate = datetime.timedelta(seconds=round(updates * seconds_per_update(options, parameters, optimizer)))
    print(
        f"plan: {updates} updates of {options.envs} x {options.horizon} steps, {updates * steps:,} steps in about "
        f"{estimate} (h:mm:ss)",
        flush=True,
    )
    bar = tqdm(total=updates * steps, unit=" steps", unit_scale=True, disable=None)  # only in a terminal
    state, points, began = optimizer.init(parameters), [], time.perf_counter()
    for number in range(1, updates + 1):
        key, to_play, to_learn = jax.random.split(key, 3)
        batch = player.play(parameters, to_play, options.horizon)
        parameters, state = update(parameters, state, batch, to_learn, optimizer, options.epochs, options.parts)
        line = f"update {number}: {len(player.scores)} games"
        if player.scores:
            points.append((number * steps, float(np.mean(player.scores[-GAMES_OF_MEAN:]))))
            line += f", mean score of the last {GAMES_OF_MEAN}: {points[-1][1]:.1f}"
        bar.clear()
        print(line, flush=True)
        bar.update(steps)
    bar.close()
    seconds = time.perf_counter() - began
    print(
        f"{updates * steps / seconds:.0f} steps a second; the environments took "
        f"{100 * player.seconds / seconds:.0f} % of the time"
    )
    if options.curve and points:
        draw(options.curve, points, random_score(options), f"PPO on the {options.observe} of {options.game}")
    return parameters


def main():
    """Reads the options, then learns or reads a policy, and plays with it as they say."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument(
        "game", nargs="?", default="updraft", help="a game, or the file of an image (default: %(default)s)"
    )
    parser.add_argument(
        "--observe", choices=("ram", "pixels"), default="ram", help="what the agent sees (default: %(default)s)"
    )
    parser.add_argument("--envs", type=int, default=32, help="environments that play at once (default: %(default)s)")
    parser.add_argument(
        "--steps",
        type=int,
        default=409600,
        help="steps of the agent that learns, of 4 frames each, in all environments (default: %(default)s)",
    )
    parser.add_argument(
        "--horizon", type=int, default=128, help="steps of each environment before an update (default: %(default)s)"
    )
    parser.add_argument("--epochs", type=int, default=4, help="epochs per update (default: %(default)s)")
    parser.add_argument("--parts", type=int, default=4, help="minibatches per epoch (default: %(default)s)")
    parser.add_argument(
        "--rate", type=float, default=1e-3, help="initial learning rate, which falls to 0 (default: %(default)s)"
    )
    parser.add_argument("--seed", type=int, default=1, help="seed of the games and of the agent (default: %(default)s)")
    parser.add_argument("--server", help="the address of a server that runs the environments, such as unix:PATH")
    parser.add_argument("--curve", metavar="FILE", help="a PNG of the scores, beside that of random play")
    parser.add_argument("--keep", metavar="FILE", help="the file for the policy, at the end")
    parser.add_argument("--play", metavar="FILE", help="play with the policy of this file, and do not learn")
    parser.add_argument("--games", type=int, default=10, help="games that --play plays (default: %(default)s)")
    parser.add_argument("--film", metavar="FILE", help="a GIF of a game with the policy; it needs Pillow")
    parser.add_argument("--log", metavar="FILE", help="the log of a game with the policy, FILE.episode")
    options = parser.parse_args()
    if options.envs * options.horizon % options.parts:
        parser.error(
            f"--parts is {options.parts}, which does not divide the {options.envs * options.horizon} steps of an update"
        )
    if options.steps < options.envs * options.horizon:
        parser.error(f"--steps is {options.steps}; an update takes {options.envs * options.horizon}")

    try:
        player = Player(options)
        key, first = jax.random.split(jax.random.key(options.seed))
        parameters = player.network(first)
        parameters = restore(options.play, parameters) if options.play else learn(options, player, parameters, key)
        if options.keep:
            keep(options.keep, parameters)
        if options.play or options.film:
            play_games(options, parameters)
        if options.log:
            log_game(options, parameters)
    except (racebeam.InvalidInput, racebeam.Refused, OSError, ValueError) as error:
        sys.exit(f"ppo.py: {error}")


if __name__ == "__main__":
    main()
