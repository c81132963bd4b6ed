"""Code that catches the exceptions of ale_py catches those of racebeam.ale_py."""

import warnings

import package
import pytest

package.require("ale_py", "gymnasium", "numpy")

import ale_py
import numpy as np
import racebeam.ale_py as drop_in


@pytest.mark.needs_roms("pong")
class TestRefusals:
    """Code that catches what ale_py raises catches what the drop-in raises."""

    def test_every_type_is_caught(self, subtests):
        def make(name, *arguments, **named):
            return lambda module: getattr(module, name)(*arguments, **named)

        def call(name, method, *arguments, **named):
            return lambda module: getattr(self.make(module, name), method)(*arguments, **named)

        calls = [make("AtariEnv", game) for game in ("nope", 3)]
        calls += [make("AtariVectorEnv", "nope", 2)]
        calls += [
            make("AtariEnv", "pong", **{name: value})
            for name, value in (
                ("mode", 99),
                ("mode", "x"),
                ("difficulty", 99),
                ("difficulty", 1.5),
                ("obs_type", "x"),
                ("frameskip", 0),
                ("frameskip", 2.0),
                ("frameskip", (3, 2)),
                ("repeat_action_probability", "x"),
                ("max_num_frames_per_episode", "x"),
                ("render_mode", "x"),
                ("foo", 1),
            )
        ]
        calls += [
            make("AtariVectorEnv", "pong", 2, **{name: value})
            for name, value in (
                ("batch_size", -1),
                ("num_threads", "x"),
                ("img_height", "x"),
                ("img_height", -3),
                ("stack_num", -1),
                ("frameskip", 0),
                ("frameskip", (2, 5)),
                ("noop_max", "x"),
                ("autoreset_mode", "x"),
                ("autoreset_mode", 3),
                ("repeat_action_probability", "x"),
                ("foo", 1),
            )
        ]
        calls += [
            call("AtariEnv", *words)
            for words in (
                ("step", "x"),
                ("step", 99),
                ("step", None),
                ("render",),
                ("get_keys_to_action", 1),
                ("restore_state", 3),
            )
        ]
        calls += [
            call("AtariVectorEnv", "step", actions)
            for actions in ([0, 0], np.zeros(3, int), np.zeros(2), np.zeros(2, np.int8), None, np.zeros((2, 1), int))
        ]
        calls += [
            call("AtariVectorEnv", "reset", seed=seed)
            for seed in ("x", 2**70 * 1.5, np.zeros(3, int), np.zeros((2, 1), int))
        ]
        calls += [
            call("AtariVectorEnv", "reset", options={"reset_mask": mask})
            for mask in (3, [True, False], np.zeros(2, int), np.zeros(3, bool), np.zeros((2, 1), bool))
        ]
        calls += [
            lambda module: module.AtariVectorEnv("pong", 2).step(np.zeros(2, int)),
            lambda module: module.AtariVectorEnv("pong", 2).reset(options={"reset_mask": np.array([True, False])}),
        ]
        calls += [
            lambda module: self.make(module, "AtariVectorEnv").ale.reset([0, 1], [1]),
            lambda module: self.make(module, "AtariVectorEnv").ale.send([0, 0], [1.0]),
        ]
        for number, refused_call in enumerate(calls):
            with subtests.test(call=number):
                raised = []
                for module in (ale_py, drop_in):
                    with warnings.catch_warnings(), pytest.raises(Exception) as refusal:
                        warnings.simplefilter("ignore")
                        refused_call(module)
                    raised.append(type(refusal.value))
                assert issubclass(raised[1], raised[0]), raised

    def make(self, module, name):
        env = getattr(module, name)(*(["pong", 2] if name == "AtariVectorEnv" else ["pong"]))
        env.reset(seed=1)
        return env
