"""environment::Batch shows what ALE's vector environment shows: observations, rewards, ends, lives, counters, byte for
byte."""

import os
import subprocess
import sys

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))))
PROBE = os.environ.get("RACEBEAM_BATCH_PROBE", os.path.join(SOURCE, "build/release/tests/environment/batch_probe"))

sys.path.insert(0, os.path.join(SOURCE, "tests", "support"))
import pytest  # noqa: E402

pytest.importorskip("numpy")
pytest.importorskip("ale_py")
pytest.importorskip("gymnasium")

import numpy as np  # noqa: E402
from ale_py import roms  # noqa: E402
from ale_py.vector_env import AtariVectorEnv  # noqa: E402
from gymnasium.vector import AutoresetMode  # noqa: E402

# Our names of the reference's settings.
NAMES = {
    "frameskip": "frame_skip",
    "repeat_action_probability": "sticky",
    "noop_max": "noop_max",
    "use_fire_reset": "fire",
    "reward_clipping": "clip",
    "episodic_life": "life_loss_ends",
    "life_loss_info": "life_loss_is_told",
    "stack_num": "stack",
    "maxpool": "max_pool",
    "max_num_frames_per_episode": "max_episode_frames",
    "full_action_space": "all_legal_actions",
    "img_width": "width",
    "img_height": "height",
    "continuous": "continuous",
}
MACHINES = 3


class Probe:
    def __init__(self, game, seed, same_step, options, start="seed"):
        settings = [f"{NAMES[key]}={float(value)}" for key, value in options.items() if key in NAMES]
        grayscale = options.get("grayscale", True)
        settings.append(f"rgb={int(not grayscale)}")
        if options.get("continuous"):
            settings.append("all_legal_actions=1")
        images = ",".join([str(roms.get_rom_path(game))] * MACHINES)
        self.process = subprocess.Popen(
            [PROBE, images, f"{start}={seed}", f"same_step={int(same_step)}", "threads=2", *settings],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
        )
        self.shape = (
            MACHINES,
            options.get("stack_num", 4),
            options.get("img_height", 84),
            options.get("img_width", 84),
        )
        self.shape += () if grayscale else (3,)
        self.same_step = same_step

    def take(self, dtype, *shape):
        count = int(np.prod(shape)) * np.dtype(dtype).itemsize
        return np.frombuffer(self.process.stdout.read(count), dtype).reshape(shape)

    def results(self):
        result = {"observation": self.take(np.uint8, *self.shape)}
        if self.same_step:
            result["final"] = self.take(np.uint8, *self.shape)
        for name in ("reward", "lives", "frame_number", "episode_frame_number"):
            result[name] = self.take(np.int32, MACHINES)
        for name in ("terminated", "truncated", "finished"):
            result[name] = self.take(np.uint8, MACHINES).astype(bool)
        return result

    def step(self, actions):
        self.process.stdin.write(np.asarray(actions, np.float32 if actions.ndim == 2 else np.int32).tobytes())
        self.process.stdin.flush()
        return self.results()

    def close(self):
        self.process.stdin.close()
        self.process.stdout.close()
        self.process.wait()


@pytest.mark.usefixtures("self_subtests")
class TestBatch:
    def same(self, name, ours, theirs, step):
        assert np.array_equal(ours, theirs), f"{name} of step {step}: {ours} instead of {theirs}"

    def check_counters(self, ours, info, step):
        for name in ("lives", "frame_number", "episode_frame_number"):
            self.same(name, ours[name], info[name], step)

    def actions(self, random, before, reference):
        if before.ndim == 2:
            return random.uniform([0, -np.pi, 0], [1, np.pi, 1], (MACHINES, 3)).astype(np.float32)
        fresh = random.integers(0, reference.single_action_space.n, MACHINES)
        return np.where(random.random(MACHINES) < 0.4, fresh, before)

    def compare(self, game, seed, steps, same_step=False, start="seed", **options):
        """The number of episodes that ended."""
        mode = AutoresetMode.SAME_STEP if same_step else AutoresetMode.NEXT_STEP
        reference = AtariVectorEnv(game, num_envs=MACHINES, autoreset_mode=mode, **options)
        probe = Probe(game, seed, same_step, options, start)
        random = np.random.default_rng(seed)
        ends = 0
        try:
            shown, info = reference.reset(seed=seed)
            ours = probe.results()
            self.same("observation", ours["observation"], shown, "reset")
            self.check_counters(ours, info, "reset")
            actions = np.zeros((MACHINES, 3), np.float32) if options.get("continuous") else np.zeros(MACHINES, np.int64)
            for step in range(steps):
                actions = self.actions(random, actions, reference)
                shown, rewards, terminated, truncated, info = reference.step(actions)
                ours = probe.step(actions)
                self.same("observation", ours["observation"], shown, step)
                for name, theirs in (("reward", rewards), ("terminated", terminated), ("truncated", truncated)):
                    self.same(name, ours[name], theirs, step)
                self.check_counters(ours, info, step)
                if same_step and ours["finished"].any():
                    for machine in np.flatnonzero(ours["finished"]):
                        self.same("final observation", ours["final"][machine], info["final_obs"][machine], step)
                ends += int(ours["finished"].sum())
            return ends
        finally:
            probe.close()
            reference.close()

    def check(self, cases, least_ends):
        ends = 0
        for number, (game, steps, options) in enumerate(cases):
            with self.subtests.test(game=game, **options):
                ends += self.compare(game, 11 + number, steps, **options)
        assert ends >= least_ends, "too few episodes ended for the test to mean much"

    def test_defaults(self):
        self.check([(game, 400, {}) for game in ("breakout", "pong", "ms_pacman", "seaquest", "air_raid")], 3)

    def test_skips_stacks_noops_and_stickiness(self):
        self.check(
            [
                ("breakout", 500, {"frameskip": 1, "repeat_action_probability": 0.25}),
                ("breakout", 300, {"frameskip": 3, "stack_num": 2, "noop_max": 0}),
                ("assault", 250, {"frameskip": 2, "stack_num": 1, "maxpool": False, "noop_max": 1}),
                ("qbert", 300, {"frameskip": 5, "repeat_action_probability": 0.25, "use_fire_reset": False}),
                ("freeway", 200, {"reward_clipping": False, "full_action_space": True}),
            ],
            1,
        )

    def test_ends_in_the_middle_of_a_step(self):
        self.check(
            [
                ("breakout", 150, {"max_num_frames_per_episode": limit, "frameskip": skip, "maxpool": pool})
                for limit, skip, pool in ((50, 4, True), (51, 4, True), (49, 4, False), (60, 7, True), (30, 1, True))
            ],
            50,
        )

    def test_lost_lives(self):
        self.check(
            [
                ("breakout", 350, {"episodic_life": True}),
                ("breakout", 350, {"life_loss_info": True}),
                ("ms_pacman", 350, {"episodic_life": True, "frameskip": 3}),
                ("seaquest", 350, {"episodic_life": True, "repeat_action_probability": 0.25}),
            ],
            10,
        )

    def test_resets_in_the_same_step(self):
        self.check(
            [
                ("breakout", 350, {"same_step": True}),
                ("breakout", 350, {"same_step": True, "episodic_life": True}),
                ("pong", 200, {"same_step": True, "max_num_frames_per_episode": 101}),
            ],
            10,
        )

    def test_sizes_and_colours(self):
        sizes = [
            {"img_width": 100, "img_height": 50},
            {"img_width": 160, "img_height": 210, "stack_num": 1},
            {"img_width": 64, "img_height": 64, "maxpool": False},
            {"img_width": 160, "img_height": 105},
        ]
        self.check(
            [("breakout", 60, {"grayscale": grayscale, **size}) for size in sizes for grayscale in (True, False)]
            + [
                ("air_raid", 60, {"grayscale": False}),
                ("pong", 120, {"grayscale": False, "same_step": True, "max_num_frames_per_episode": 50}),
            ],
            10,
        )

    def test_a_reset_with_a_seed(self):
        self.check(
            [
                (game, 150, {"start": "reset", "repeat_action_probability": 0.25, "max_num_frames_per_episode": 200})
                for game in ("breakout", "seaquest", "pong")
            ],
            3,
        )

    def test_continuous_actions(self):
        self.check(
            [
                (game, 300, {"continuous": True, "max_num_frames_per_episode": 500, "repeat_action_probability": 0.25})
                for game in ("breakout", "pong", "ms_pacman")
            ],
            3,
        )
