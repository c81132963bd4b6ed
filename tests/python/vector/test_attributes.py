"""AtariVectorEnv: its attributes, its options, and Gymnasium's own wrappers."""

import dataclasses
import inspect
import re

import package
import pytest

package.require("numpy", "gymnasium")

import gymnasium
import numpy as np
import racebeam
from gymnasium.error import Error
from gymnasium.vector import AutoresetMode
from gymnasium.wrappers.vector import DictInfoToList, RecordEpisodeStatistics
from racebeam import AtariVectorEnv
from racebeam.vector_options import OptionArguments, VectorOptions
from vectors import SHORT, play, same

GYMNASIUM = tuple(map(int, gymnasium.__version__.split(".")[:3]))


class TestAttributes:
    def test_the_actions_of_each_environment(self):
        envs = AtariVectorEnv(["beamfall", "updraft"], full_action_space=True)
        names = [action.name for action in racebeam.Action]
        assert envs.get_action_meanings(1) == names
        assert envs.call("get_action_meanings") == (names, names)
        single = racebeam.AtariEnv("beamfall")
        assert AtariVectorEnv("beamfall", 2).get_action_meanings() == single.get_action_meanings()
        for env in (2, -1):
            with pytest.raises(IndexError, match=f"environment {env}"):
                envs.get_action_meanings(env)

    @pytest.mark.parametrize(("left", "last"), (("joystick", "BW"), ("genesis", "DOWNLEFTFIRE+C")))
    def test_actions_of_the_console_and_of_controllers_have_names(self, left, last):
        arguments = {"full_action_space": "console", "left": left}
        envs = AtariVectorEnv("beamfall", 2, **arguments)
        names = envs.get_action_meanings(1)
        assert names == racebeam.AtariEnv("beamfall", **arguments).get_action_meanings()
        assert (len(names), names[-1]) == (envs.single_action_space.n, last)

    def test_attributes_and_calls(self):
        envs = AtariVectorEnv(["beamfall", "updraft"], full_action_space=True)
        assert envs.get_attr("game") == ("beamfall", "updraft")
        assert envs.get_attr("grayscale") == (True, True)
        assert len(envs.call("save", include_rng=False)) == 2
        with pytest.raises(AttributeError):
            envs.get_attr("colour")
        with pytest.raises(AttributeError, match="get_action_meanings"):
            envs.call("step")

    def test_the_text_names_the_game(self):
        assert repr(AtariVectorEnv("beamfall", 2)) == "AtariVectorEnv(game='beamfall', num_envs=2)"
        assert (
            repr(AtariVectorEnv(["beamfall", "updraft"], full_action_space=True))
            == "AtariVectorEnv(game=['beamfall', 'updraft'], num_envs=2)"
        )
        assert (
            repr(racebeam.AtariEnv("beamfall", frameskip=(2, 5)))
            == "AtariEnv(game='beamfall', obs_type='rgb', frameskip=(2, 5))"
        )
        assert str(racebeam.AtariEnv("beamfall")) == "<AtariEnv<beamfall>>"
        assert str(gymnasium.make("racebeam/Beamfall-v5").unwrapped) == "<AtariEnv<racebeam/Beamfall-v5>>"


class TestOptions:
    def test_they_are_checked_and_cannot_be_changed(self):
        options = VectorOptions(num_envs=np.int64(4), autoreset_mode="SAME_STEP", seed=np.int64(3))
        assert (type(options.num_envs), options.batch_size, options.autoreset_mode) == (int, 4, AutoresetMode.SAME_STEP)
        with pytest.raises(dataclasses.FrozenInstanceError):
            options.seed = 4
        with pytest.raises(Error, match="batch_size is 5"):
            dataclasses.replace(options, batch_size=5)

    def test_the_constructor_takes_each_of_them(self):
        fields, arguments = (
            {field.name for field in dataclasses.fields(VectorOptions)},
            set(OptionArguments.__annotations__),
        )
        assert fields - arguments == {"num_envs", "rows"}
        assert arguments - fields == {"episodic_life", "life_loss_info", "lives"}

    def test_help_names_each_of_them_and_its_default(self, subtests):
        documented = dict(
            re.findall(r"(?ms)^ {8}(\w+): (.*?)(?=^ {8}\w|^$)", inspect.getdoc(AtariVectorEnv).replace("\n", "\n    "))
        )
        for field in dataclasses.fields(VectorOptions):
            if field.name not in ("num_envs", "rows"):
                with subtests.test(option=field.name):
                    assert "Default:" in documented[field.name]

    def test_an_object_has_the_options_of_several_vectors(self):
        options = VectorOptions.of_preset("machado2018", num_envs=3, obs_type="ram", seed=7)
        envs, others = (
            AtariVectorEnv("beamfall", options=options),
            AtariVectorEnv("updraft", 5, options=options, seed=8),
        )
        same_by_words = AtariVectorEnv("beamfall", 3, preset="machado2018", obs_type="ram", seed=7)
        assert same(play(envs, 20), play(same_by_words, 20))
        assert (envs.num_envs, envs.batch_size, others.num_envs, others.batch_size) == (3, 3, 5, 5)
        assert others.reset()[0].tolist() == AtariVectorEnv("updraft", 5, options=options).reset(seed=8)[0].tolist()

    def test_the_defaults_are_those_of_the_preset_ale(self):
        assert VectorOptions(seed=1) == VectorOptions.of_preset(seed=1)

    def test_a_batch_of_some_environments_stays_one(self):
        options = VectorOptions(num_envs=4, batch_size=2)
        assert AtariVectorEnv("beamfall", options=options).batch_size == 2
        with pytest.raises(Error, match="batch_size is 2"):
            AtariVectorEnv("beamfall", 1, options=options)

    def test_the_core_has_what_they_say(self):
        core = VectorOptions(
            obs_type="ram", life_loss="end", max_num_frames_per_episode=7, reward_clipping=False
        )._core_settings()
        assert (core.stack, core.lives.name, core.max_episode_frames, core.reward_max) == (0, "END", 7, 2**31 - 1)


class TestGymnasium:
    def test_make_vec(self):
        envs = gymnasium.make_vec("racebeam/Beamfall-v5", 3, img_height=50)
        assert isinstance(envs.unwrapped, AtariVectorEnv)
        assert envs.reset(seed=1)[0].shape == (3, 4, 50, 84)
        sticky = AtariVectorEnv("beamfall", 3, img_height=50, repeat_action_probability=0.25)
        sticky.reset(seed=1)
        assert same(play(envs.unwrapped, 20), play(sticky, 20))

    def test_wrappers(self):
        envs = RecordEpisodeStatistics(AtariVectorEnv("beamfall", 2, frameskip=60, seed=1))
        infos = [envs.step(np.ones(2, int))[4] for _ in range(60)]
        assert any("episode" in info for info in infos)

    @pytest.mark.skipif(GYMNASIUM < (1, 2, 3), reason="DictInfoToList needs a mask for each key")
    def test_infos_as_lists(self):
        envs = DictInfoToList(AtariVectorEnv("beamfall", 2, autoreset_mode="SameStep", **SHORT))
        envs.reset(seed=1)
        infos = [envs.step(np.ones(2, int))[4] for _ in range(3)]
        assert infos[2][1]["final_obs"].shape == (4, 84, 84)
        assert infos[2][1]["final_info"]["episode_frame_number"] == 13
        assert "final_obs" not in infos[1][1]
