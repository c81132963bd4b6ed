"""AtariVectorEnv.xla(): programs that JAX compiles play what step() plays, and bad input is an error."""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

import package
import pytest

package.require("gymnasium", "numpy", "jax")

import gymnasium
import jax
import jax.numpy as jnp
import numpy as np
import racebeam
import racebeam.ale_py.vector_env
from racebeam import AtariVectorEnv, InvalidInput

COUNT, STEPS = 3, 30
ACTIONS = np.random.default_rng(1).integers(0, 3, (STEPS, COUNT), dtype=np.int32)


def both(**settings):
    return [
        AtariVectorEnv("beamfall", COUNT, **{"seed": 1, "repeat_action_probability": 0.25, **settings})
        for _ in range(2)
    ]


class TestCompiled:
    def check(self, shown, expected):
        assert jax.tree.structure(shown) == jax.tree.structure(expected)
        for one, other in zip(jax.tree.leaves(shown), jax.tree.leaves(expected)):
            assert (one.dtype, one.shape) == (other.dtype, other.shape)
            assert np.array_equal(one, other)

    @pytest.mark.parametrize(
        "settings",
        (
            {},
            {"obs_type": "ram", "autoreset_mode": "Disabled"},
            {"grayscale": False, "stack_num": 1, "reward_clipping": False},
            {"max_num_frames_per_episode": 40},
        ),
    )
    def test_step_and_reset_under_jit(self, settings):
        compiled, plain = both(**settings)
        handle, reset, step = compiled.xla()
        plain.xla()  # from now on, a reset without a seed continues the generators, also the first one
        reset, step = jax.jit(reset), jax.jit(step)
        mask = np.array([True, False, True])
        for arguments in ({}, {"seed": 2**31 - 5}, {"seed": np.array([4, -1, 9])}, {"reset_mask": mask}):
            handle, result = reset(handle, **arguments)
            options = {"reset_mask": arguments["reset_mask"]} if "reset_mask" in arguments else None
            self.check(result, plain.reset(seed=arguments.get("seed"), options=options))
            for actions in ACTIONS[:12]:
                handle, result = step(handle, actions)
                self.check(result, plain.step(actions))

    def test_scan(self):
        compiled, plain = both()
        handle, _, step = compiled.xla()
        handle, (observations, rewards, *ends, infos) = jax.lax.scan(step, handle, ACTIONS)
        for index, actions in enumerate(ACTIONS):
            results = (
                observations[index],
                rewards[index],
                *(end[index] for end in ends),
                {key: value[index] for key, value in infos.items()},
            )
            self.check(results, plain.step(actions))

    def test_fori_loop_with_actions_from_observations(self):
        compiled, plain = both()
        handle, reset, step = compiled.xla()

        @jax.jit
        def play(handle):
            def body(_, carry):
                handle, observations, total = carry
                handle, (observations, rewards, *_) = step(handle, observations.sum((1, 2, 3)) % 3)
                return handle, observations, total + rewards

            handle, (observations, _) = reset(handle, 7)
            return jax.lax.fori_loop(0, STEPS, body, (handle, observations, jnp.zeros(COUNT, jnp.int32)))

        _, observations, total = play(handle)
        expected, _ = plain.reset(seed=7)
        sum_of_rewards = 0
        for _ in range(STEPS):
            expected, rewards, *_ = plain.step(expected.sum((1, 2, 3)) % 3)
            sum_of_rewards += rewards
        assert np.array_equal(observations, expected)
        assert np.array_equal(total, sum_of_rewards)

    def test_a_result_that_is_not_used_is_played_all_the_same(self):
        compiled, _ = both()
        handle, _, step = compiled.xla()
        jax.block_until_ready(jax.jit(lambda handle: step(handle, np.zeros(COUNT, np.int32))[0])(handle))
        assert compiled.show()[1]["episode_frame_number"].min() > 3

    def test_unsigned_seeds_of_jax_are_seeds(self):
        compiled, plain = both()
        handle, reset, _ = compiled.xla()
        seeds = np.array([3 * 10**9, 2**32 - 1, 7], np.uint32)
        for call in (reset, jax.jit(reset)):
            for _ in range(2):
                handle, result = call(handle, jnp.asarray(seeds))
                self.check(result, plain.reset(seed=(seeds & 0x7FFFFFFF).astype(np.int64)))
                handle, result = call(handle, jnp.uint32(2**32 - 1))  # counts on at 0
                self.check(result, plain.reset(seed=[2**31 - 1, 0, 1]))

    @pytest.mark.parametrize("seed", (2**31 - COUNT, np.full(COUNT, 2**31 - 1)))
    def test_the_largest_seeds_are_taken(self, seed):
        compiled, plain = both(obs_type="ram")
        handle, reset, _ = compiled.xla()
        self.check(reset(handle, seed)[1], plain.reset(seed=seed))

    def test_continuous_actions(self):
        compiled, plain = both(continuous=True, continuous_action_threshold=0.3)
        handle, _, step = compiled.xla()
        plain.action_space.seed(1)
        for _ in range(10):
            actions = plain.action_space.sample()
            handle, result = step(handle, actions)
            self.check(result, plain.step(actions))

    def test_two_handles_are_two_sets_of_environments(self):
        one, other = both()
        (first, _, step), (second, _, _) = one.xla(), other.xla()
        first, _ = step(first, ACTIONS[0])
        _, result = step(first, ACTIONS[1])
        second, _ = step(second, ACTIONS[0])
        self.check(step(second, ACTIONS[1])[1], result)

    @pytest.mark.needs_roms("breakout")
    def test_ale_py_returns_the_same(self):
        for name in ("ale_py.vector_env", "chex"):
            if not package.has(name):
                pytest.skip(f"{name} is not installed")
        import ale_py.vector_env

        ours, theirs = (
            module.AtariVectorEnv("breakout", COUNT) for module in (racebeam.ale_py.vector_env, ale_py.vector_env)
        )
        assert ours.is_xla_registered == theirs.is_xla_registered
        (handle, reset, step), (other, other_reset, other_step) = ours.xla(), theirs.xla()
        assert (ours.is_xla_registered, handle.dtype, handle.shape) == (
            theirs.is_xla_registered,
            other.dtype,
            other.shape,
        )
        for arguments in ({"seed": 3}, {"reset_mask": np.array([True, False, True])}, {"seed": np.array([1, 2, 3])}):
            handle, result = reset(handle, **arguments)
            other, expected = other_reset(other, **arguments)
            self.check(result, expected)
            for actions in ACTIONS[:10]:
                handle, result = step(handle, actions)
                other, expected = other_step(other, actions)
                self.check(result, expected)


class TestRefused:
    def test_errors_before_anything_is_compiled(self):
        envs = both()[0]
        handle, reset, step = envs.xla()
        *_, push = both(continuous=True)[0].xla()
        for error, call in (
            (InvalidInput, lambda: push(handle, np.zeros((COUNT, 2), np.float32))),
            (TypeError, lambda: step(handle, np.zeros(COUNT))),
            (InvalidInput, lambda: step(handle, ACTIONS[0][:2])),
            (InvalidInput, lambda: reset(handle, np.zeros(2, np.int32))),
            (TypeError, lambda: reset(handle, 0.5)),
            (TypeError, lambda: reset(handle, None, np.zeros(COUNT))),
            (InvalidInput, lambda: reset(handle, None, np.ones(2, bool))),
            (InvalidInput, AtariVectorEnv("beamfall", 2, autoreset_mode="SameStep").xla),
            (InvalidInput, AtariVectorEnv("beamfall", 2, batch_size=1).xla),
            (InvalidInput, AtariVectorEnv("beamfall", 2, sound_obs=True).xla),
        ):
            with pytest.raises(error):
                call()
        envs.close()
        with pytest.raises(gymnasium.error.ClosedEnvironmentError):
            envs.xla()

    def test_a_compiled_program_gets_the_infos(self):
        envs = both()[0]
        handle, _, step = envs.xla()
        for action in (99, -1):
            with pytest.raises(jax.errors.JaxRuntimeError, match=f"action {action} is out of range; accepted: 0 to"):
                jax.block_until_ready(step(handle, np.array([0, action, 0])))
        jax.block_until_ready(step(handle, ACTIONS[0]))
        for made_up in (np.zeros(8, np.uint8), np.full(8, 255, np.uint8)):
            with pytest.raises(jax.errors.JaxRuntimeError, match="were closed"):
                jax.block_until_ready(step(jnp.asarray(made_up), ACTIONS[0]))
        envs.close()
        with pytest.raises(jax.errors.JaxRuntimeError, match="were closed"):
            jax.block_until_ready(step(handle, ACTIONS[0]))

    def test_environments_may_be_closed_while_a_program_runs(self):
        for _ in range(5):
            envs = AtariVectorEnv("beamfall", COUNT, frameskip=200)
            handle, _, step = envs.xla()
            result = jax.jit(lambda handle: jax.lax.scan(step, handle, ACTIONS))(handle)
            envs.close()
            try:
                jax.block_until_ready(result)
            except jax.errors.JaxRuntimeError as error:
                assert "were closed" in str(error)

    def test_seeds_that_are_too_large(self, subtests):
        handle, reset, _ = both()[0].xla()
        for seed in (
            2**31 - COUNT + 1,
            2**32 + 5,
            np.int64(2**32 + 5),
            np.uint32(3 * 10**9),
            np.array([1, 2**31, 3]),
            np.array([1, 2, 2**64 - 1], np.uint64),
        ):
            with (
                subtests.test(seed=seed),
                pytest.raises(InvalidInput, match="the seed is .*; it takes up to 21474836"),
            ):
                reset(handle, seed)

    def test_an_action_is_not_narrowed(self):
        envs = both()[0]
        handle, _, step = envs.xla()
        for actions in (np.array([0, 2**32 + 1, 0]), jnp.array([0, 3 * 10**9, 0], jnp.uint32)):
            with pytest.raises(jax.errors.JaxRuntimeError, match="action 2147483647 is out of range"):
                jax.block_until_ready(step(handle, actions))

    def test_without_jax_it_says_what_is_missing(self):
        script = (
            "import sys; sys.modules['jax'] = None\nimport racebeam\n"
            "try: racebeam.AtariVectorEnv('beamfall', 2).xla()\nexcept ImportError as error: print(error)"
        )
        done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
        assert done.stdout == 'xla() needs JAX; install it with: pip install "jax>=0.5"\n', done.stderr


# For each structure of core/xla_ffi.hpp, its name in JAX's header, and its members there, in the order of the members
# here.
STRUCTURES = {
    "Extension": ("XLA_FFI_Extension_Base", "struct_size type next"),
    "ApiVersion": ("XLA_FFI_Api_Version", "struct_size extension_start major_version minor_version"),
    "Metadata": ("XLA_FFI_Metadata", "struct_size api_version traits"),
    "MetadataExtension": ("XLA_FFI_Metadata_Extension", "extension_base metadata"),
    "ErrorCreateArgs": ("XLA_FFI_Error_Create_Args", "struct_size extension_start message errc"),
    "Api": ("XLA_FFI_Api", "struct_size extension_start api_version internal_api XLA_FFI_Error_Create"),
    "Buffer": ("XLA_FFI_Buffer", "struct_size extension_start dtype data rank dims"),
    "Buffers": ("XLA_FFI_Args", "struct_size extension_start size types args"),
    "CallFrame": ("XLA_FFI_CallFrame", "struct_size extension_start api ctx stage args rets"),
}
CONSTANTS = {
    "ErrorCode::kInvalidArgument": "Error_Code_INVALID_ARGUMENT",
    "ErrorCode::kFailedPrecondition": "Error_Code_FAILED_PRECONDITION",
    "ErrorCode::kOutOfRange": "Error_Code_OUT_OF_RANGE",
    "DataType::kBool": "DataType_PRED",
    "DataType::kInt32": "DataType_S32",
    "DataType::kUint8": "DataType_U8",
    "DataType::kFloat32": "DataType_F32",
    "kMetadataExtension": "Extension_Metadata",
    "kMajorVersion": "API_MAJOR",
}


class TestInterface:
    @pytest.mark.skipif(not shutil.which("g++"), reason="compiler is not installed")
    def test_it_is_declared_as_in_the_header_of_jax(self):
        header = package.SOURCE / "clients/python/core/xla_ffi.hpp"
        declared = dict(re.findall(r"^struct (\w+) \{\n(.*?)^\};", header.read_text(), re.M | re.S))
        assert set(declared) == set(STRUCTURES)
        checks = []
        for name, body in declared.items():
            theirs, members = STRUCTURES[name][0], STRUCTURES[name][1].split()
            ours = re.findall(r"(\w+)(?:\)\(.*\))?;", body)
            assert len(ours) == len(members), name
            checks += [
                (
                    f"offsetof(ours::{name}, {one}) == offsetof({theirs}, {other}) && sizeof(ours::{name}::{one}) "
                    f"== sizeof({theirs}::{other})"
                )
                for one, other in zip(ours, members)
            ]
        checks += [f"int(ours::{one}) == int(XLA_FFI_{other})" for one, other in CONSTANTS.items()]
        checks += ["sizeof(XLA_FFI_Rets) == sizeof(XLA_FFI_Args)", "ours::kMinorVersion <= XLA_FFI_API_MINOR"]
        text = (
            f'#include "{header}"\n#include "xla/ffi/api/c_api.h"\nnamespace ours = racebeam::python::xla;\n'
            + "".join(f"static_assert({check});\n" for check in checks)
        )
        with tempfile.TemporaryDirectory() as folder:
            source = pathlib.Path(folder, "check.cpp")
            source.write_text(text)
            done = subprocess.run(
                ["g++", "-std=c++20", "-fsyntax-only", "-Wno-invalid-offsetof", f"-I{jax.ffi.include_dir()}", source],
                capture_output=True,
                text=True,
            )
        assert done.returncode == 0, done.stderr
