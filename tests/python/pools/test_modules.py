"""racebeam.envpool: what programs import, and specs."""

import copy
import pickle
import subprocess
import sys

import package
import pytest

package.require("numpy", "gymnasium")

import numpy as np
import racebeam
from pools import make
from racebeam import InvalidInput, envpool


class TestModules:
    """What programs import from EnvPool."""

    def test_in_the_place_of_envpool(self):
        script = (
            "import sys, racebeam.envpool\n"
            "sys.modules['envpool'] = racebeam.envpool\n"
            "import envpool, envpool.registration, envpool.atari.registration\n"
            "from envpool.atari import AtariDMEnvPool, AtariEnvSpec, AtariGymnasiumEnvPool\n"
            "from envpool.python import protocol\n"
            "for name in ('EnvSpec', 'EnvPool', 'DMEnvPool', 'GymnasiumEnvPool'):\n"
            "    assert getattr(protocol, name) is getattr(envpool, name) and name in envpool.__all__\n"
            "assert envpool.registration.make is envpool.make and AtariEnvSpec is envpool.EnvSpec\n"
            "assert len(envpool.atari.registration.atari_game_list) == 104 and envpool.__version__\n"
            "envs = AtariGymnasiumEnvPool(AtariEnvSpec(AtariEnvSpec.gen_config(task='beamfall', num_envs=2)))\n"
            "print(envs.reset()[0].shape)"
        )
        done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
        assert (done.returncode, done.stdout) == (0, "(2, 4, 84, 84)\n"), done.stderr

    def test_a_spec_of_settings(self):
        config = envpool.EnvSpec.gen_config(task="beamfall", num_envs=4, batch_size=5)
        assert (config.batch_size, config.max_episode_steps) == (5, 2**31 - 1)
        with pytest.raises(ValueError, match="batch_size is 5; it takes 0 to 4"):
            envpool.EnvSpec(config)
        with pytest.raises(TypeError, match="unknown setting 'foo'"):
            envpool.EnvSpec.gen_config(foo=3)
        with pytest.raises(InvalidInput, match="there are 2 values; there must be 26"):
            envpool.EnvSpec((1, 2))
        for task in ("nope", ["x"], ""):
            with pytest.raises(racebeam.UnknownGame, match="unknown game"):
                envpool.EnvSpec(envpool.EnvSpec.gen_config(task=task))
        with pytest.raises(InvalidInput, match="the spec is 3"):
            envpool.GymnasiumEnvPool(3)

    def test_the_raw_interface(self):
        from racebeam.envpool.atari.atari_envpool import _AtariEnvPool, _AtariEnvSpec

        config = {
            **dict(zip(_AtariEnvSpec._config_keys, _AtariEnvSpec._default_config_values)),
            "task": b"beamfall",
            "num_envs": 3,
        }
        raw, envs = _AtariEnvPool(_AtariEnvSpec(tuple(config.values()))), make("dm")
        raw._reset(np.arange(3, dtype=np.int32))
        time_step = envs.reset()
        for step in range(20):
            state = dict(zip(raw._state_keys, raw._recv()))
            for name, value in (
                ("obs", time_step.observation.obs),
                ("step_type", time_step.step_type),
                ("reward", time_step.reward),
                ("info:ram", time_step.observation.ram),
                ("discount", time_step.discount),
            ):
                assert np.array_equal(state[name], value), name
            actions = np.array([step % 18, 1, 2])
            raw._send((state["info:env_id"], state["info:players.env_id"], actions))
            time_step = envs.step(actions)
        assert raw._state_keys == list(envs.spec.state_array_spec)
        with pytest.raises(InvalidInput, match="the action has 1 arrays"):
            raw._send((actions,))

    def test_a_pool_is_not_copied(self):
        for copied in (pickle.dumps, copy.deepcopy):
            with pytest.raises(TypeError, match="cannot be pickled or copied"):
                copied(make())


class TestSpec:
    """What make_spec() of EnvPool 1.2.5 shows of Pong-v5, except the number of actions."""

    def test_spaces_and_settings(self):
        for config, shape, actions in (
            ({"num_envs": 4}, (4, 84, 84), 18),
            ({"gray_scale": False, "img_width": 50}, (12, 84, 50), 18),
        ):
            spec = envpool.make_spec("Beamfall-v5", **config)
            assert (spec.observation_space.shape, spec.gymnasium_observation_space.dtype) == (shape, np.uint8)
            assert (spec.action_space.n, spec.gymnasium_action_space.n, spec.reward_threshold) == (
                actions,
                actions,
                None,
            )
            assert (spec.config.num_envs, spec.config.batch_size) == (config.get("num_envs", 1),) * 2
            assert (spec.config.seed, spec.config.max_episode_steps, spec.config.task) == (42, 27000, "beamfall")
            assert repr(spec).startswith(f"AtariEnvSpec(num_envs={spec.config.num_envs}, ")
            envs = make(**config)
            assert (envs.observation_space, envs.action_space) == (spec.observation_space, spec.action_space)
            assert "Beamfall-v5" in str(envs)  # Gymnasium takes it from the spec
            assert envs.spec.config._replace(num_envs=1, batch_size=1) == spec.config._replace(num_envs=1, batch_size=1)

    def test_defaults_are_those_that_EnvPool_documents(self):
        config = envpool.make_spec("Beamfall-v5").config
        assert {name: value for name, value in config._asdict().items() if value not in (-1, "", [], "beamfall")} == {
            "num_envs": 1,
            "batch_size": 1,
            "num_threads": 0,
            "max_num_players": 1,
            "seed": 42,
            "gym_reset_return_info": True,
            "max_episode_steps": 27000,
            "stack_num": 4,
            "frame_skip": 4,
            "noop_max": 30,
            "zero_discount_on_life_loss": False,
            "episodic_life": False,
            "reward_clip": False,
            "use_fire_reset": True,
            "img_height": 84,
            "img_width": 84,
            "full_action_space": False,
            "repeat_action_probability": 0.0,
            "use_inter_area_resize": True,
            "gray_scale": True,
        }

    @pytest.mark.parametrize(
        ("name", "least", "most"),
        (
            ("num_envs", 1, 10_000_000),
            ("num_threads", 0, 2**31 - 1),
            ("thread_affinity_offset", -1, 2**31 - 1),
            ("max_episode_steps", 1, 2**31 - 1),
            ("stack_num", 1, 16),
            ("frame_skip", 1, 1000),
            ("noop_max", 0, 1000),
            ("img_height", 1, 1000),
            ("img_width", 1, 1000),
            ("mode", -1, 2**31 - 1),
            ("difficulty", -1, 2**31 - 1),
        ),
    )
    def test_whole_numbers_have_limits(self, name, least, most):
        envpool.make_spec("Beamfall-v5", **{name: least})
        for value in (least - 1, most + 1):
            with pytest.raises(InvalidInput, match=f"{name} is {value}; it takes {least} to {most}"):
                envpool.make_spec("Beamfall-v5", **{name: value})

    def test_arrays(self):
        spec = envpool.make_spec("Beamfall-v5")
        assert {
            name: (array.shape, np.dtype(array.dtype).name, array.minimum, array.maximum)
            for name, array in spec.state_array_spec.items()
        } == {
            "info:env_id": ([], "int32", -(2**31), 2**31 - 1),
            "info:players.env_id": ([-1], "int32", -(2**31), 2**31 - 1),
            "elapsed_step": ([], "int32", -(2**31), 2**31 - 1),
            "done": ([], "bool", False, True),
            "reward": ([-1], "float32", np.finfo(np.float32).min, np.finfo(np.float32).max),
            "discount": ([-1], "float32", 0, 1),
            "step_type": ([], "int32", -(2**31), 2**31 - 1),
            "trunc": ([], "bool", False, True),
            "obs": ([4, 84, 84], "uint8", 0, 255),
            "info:lives": ([-1], "int32", -(2**31), 2**31 - 1),
            "info:reward": ([-1], "float32", np.finfo(np.float32).min, np.finfo(np.float32).max),
            "info:terminated": ([-1], "int32", 0, 1),
            "info:ram": ([128], "uint8", 0, 255),
        }
        assert spec.action_array_spec["action"] == (np.int32, [-1], 0, 17)

    def test_results_fit_their_specs(self):
        envs = make("dm")
        result = envs.reset()
        names = {name.removeprefix("info:"): array for name, array in envs.spec.state_array_spec.items()}
        for name, array in names.items():
            value = {
                "players.env_id": result.observation.players.env_id,
                "step_type": result.step_type,
                "discount": result.discount,
            }.get(name, getattr(result.observation, name, None))
            if value is not None:
                assert (value.dtype, value.shape[1:]) == (
                    array.dtype,
                    tuple(length for length in array.shape if length != -1),
                ), name

    @pytest.mark.needs_modules("dm_env")
    def test_specs_of_dm_env(self):
        from dm_env import specs

        envs = make("dm")
        assert envs.action_spec() == specs.DiscreteArray(18, np.int32, "action")
        spec = envs.observation_spec()
        observation = envs.reset().observation
        for name in ("obs", "lives", "reward", "terminated", "ram"):
            getattr(spec, name).validate(getattr(observation, name)[0])
        spec.players.env_id.validate(observation.players.env_id[0])
        assert isinstance(spec.terminated, specs.DiscreteArray)

    def test_bad_input_is_refused(self):
        with pytest.raises(racebeam.UnknownGame):
            envpool.make_spec("Nope-v5")
        with pytest.raises(InvalidInput):
            envpool.make_spec("Beamfall-v5", foo=1)
        with pytest.raises(InvalidInput):
            envpool.make_spec("Beamfall-v5", max_num_players=2)
