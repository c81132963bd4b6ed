"""racebeam.envpool: programs that JAX compiles."""

import package
import pytest

package.require("numpy", "gymnasium")

import numpy as np
from pools import make
from racebeam import InvalidInput


@pytest.mark.needs_jax
class TestCompiled:
    """xla()."""

    def test_it_shows_what_the_environments_show(self, subtests):
        import jax

        for env_type in ("gymnasium", "gym", "dm"):
            for config in (
                {"episodic_life": True, "frame_skip": 60, "reward_clip": True},
                {"gray_scale": False, "img_height": 30, "max_episode_steps": 7},
                {"zero_discount_on_life_loss": True, "frame_skip": 60},
            ):
                with subtests.test(env_type=env_type, **config):
                    envs, others = make(env_type, **config), make(env_type, **config)
                    handle, recv, send, step = envs.xla()
                    envs.async_reset()
                    others.async_reset()
                    handle, result = recv(handle)
                    self.same(result, others.recv())
                    compiled = jax.jit(step)
                    for number in range(40):
                        actions = np.array([number % 18, 1, 3], np.int32)
                        handle, result = compiled(handle, actions)
                        self.same(result, others.step(actions))
                    ids = np.array([2, 0, 1], np.int32)
                    handle, result = step(handle, {"action": actions, "env_id": ids})
                    self.same(result, others.step(actions, ids))

    def same(self, compiled, shown):
        import jax

        ours, theirs = jax.tree.flatten(compiled), jax.tree.flatten(shown)
        assert ours[1] == theirs[1]
        for one, other in zip(ours[0], theirs[0]):
            assert (one.dtype, one.shape) == (other.dtype, other.shape)
            assert np.array_equal(one, other)

    def test_a_loop_of_some_at_a_time(self):
        import jax

        envs = make(num_envs=6, batch_size=2)
        handle, recv, send, _ = envs.xla()
        envs.async_reset()

        def step(_, carried):
            handle, steps = carried
            handle, (*_, info) = recv(handle)
            return send(handle, jax.numpy.ones(2, np.int32), info["env_id"]), steps.at[info["env_id"]].add(1)

        _, steps = jax.jit(lambda: jax.lax.fori_loop(0, 30, step, (handle, jax.numpy.zeros(6, np.int32))))()
        assert int(steps.sum()) == 60
        assert envs.recv()[4]["env_id"].shape == (2,)
        with pytest.raises(InvalidInput, match="env_id is None"):
            send(handle, np.ones(2, np.int32))

    def test_bad_input(self):
        import jax

        envs = make()
        handle, recv, send, step = envs.xla()
        with pytest.raises(InvalidInput, match=r"actions have the shape \(2,\); they must have \(3,\)"):
            send(handle, np.ones(2, np.int32))
        with pytest.raises(TypeError):
            send(handle, np.ones(3))
        for function, arguments, words in (
            (recv, (), "0 environments play, and a receive takes 3"),
            (step, (np.full(3, 99),), "out of range"),
            (step, (np.ones(1, np.int32), np.array([7])), "environment 7 is out of range"),
        ):
            with pytest.raises(jax.errors.JaxRuntimeError, match=words):
                jax.block_until_ready(function(handle, *arguments))
        envs.close()
        with pytest.raises(jax.errors.JaxRuntimeError, match="closed"):
            jax.block_until_ready(step(handle, np.ones(3, np.int32)))
