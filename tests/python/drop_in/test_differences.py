"""racebeam.ale_py differs from ale_py as its docstring lists."""

import copy
import pathlib
import pickle
import re
import tempfile

import package
import pytest

package.require("ale_py", "gymnasium", "numpy")

import ale_py
import gymnasium
import numpy as np
import racebeam
import racebeam.ale_py as drop_in
import racebeam.ale_py._ale_py
from both import INTERNAL, PONG, in_process, interfaces, pong


class TestDifferences:
    """A test for each number in the docstring."""

    def test_each_number_has_a_test(self):
        numbers = [int(number) for number in re.findall(r"(?m)^(\d+)\. ", drop_in.__doc__)]
        tests = sorted({int(name.split("_")[1]) for name in dir(self) if re.match(r"test_\d", name)})
        assert numbers == tests

    def test_01_a_bad_image_is_an_exception(self, subtests):
        with tempfile.TemporaryDirectory() as folder:
            cut = pathlib.Path(folder, "cut.bin")
            cut.write_bytes(pathlib.Path(PONG).read_bytes()[:1000])
            for image in ("/nowhere.bin", str(cut), "/dev/null"):
                with subtests.test(image=image):
                    with pytest.raises(RuntimeError):
                        drop_in.ALEInterface().loadROM(image)
                    done = in_process(f"import ale_py; ale_py.ALEInterface().loadROM({image!r})")
                    assert "Traceback" not in done.stderr  # it has ended the process itself
                    assert done.returncode != 0

    def test_02_without_an_image_every_method_raises_or_answers(self, subtests):
        unloaded = drop_in.ALEInterface()
        for name in (
            "act",
            "reset_game",
            "getRAM",
            "getScreen",
            "getScreenRGB",
            "getScreenGrayscale",
            "getAudio",
            "lives",
            "game_over",
            "game_truncated",
            "getFrameNumber",
            "getEpisodeFrameNumber",
            "getScreenDims",
            "cloneState",
            "cloneSystemState",
            "getLegalActionSet",
            "getMinimalActionSet",
            "getAvailableModes",
            "getAvailableDifficulties",
            "state_hash",
        ):
            with subtests.test(method=name), pytest.raises(RuntimeError, match="ROM not set"):
                getattr(unloaded, name)(*([0] if name == "act" else []))
        for method, words in ((unloaded.setMode, [0]), (unloaded.setDifficulty, [0]), (unloaded.setRAM, [0, 0])):
            with pytest.raises(RuntimeError, match="ROM not set"):
                method(*words)
        assert in_process("import ale_py; ale_py.ALEInterface().getRAM()").returncode < 0

    def test_03_a_number_that_is_not_an_action(self):
        ours, theirs = pong()
        for number in (18, 99):
            with pytest.raises(ValueError, match=f"action {number} is out of range; accepted: 0 to 17"):
                ours.act(number)
            assert theirs.act(number) == 0
        with pytest.raises(ValueError, match="is out of range"):
            ours.act(2**31)
        with pytest.raises(IndexError):
            drop_in.AtariEnv("pong").step(-1)
        ale_py.AtariEnv("pong").step(-1)

    def test_04_choices_are_named(self):
        with pytest.raises(RuntimeError, match="mode is 77; it takes 0, 1$"):
            pong()[0].setMode(77)
        with pytest.raises(RuntimeError, match="pong has no difficulty 77; it offers 0, 1, 2, 3"):
            pong()[0].setDifficulty(77)

    def test_05_states_are_exact(self):
        exact = []
        for ale in pong():
            [ale.act(step % 6) for step in range(100)]
            state, screen, sound = ale.cloneState(True), ale.getScreenRGB(), ale.getAudio()
            [ale.act(step % 6) for step in range(100)]
            ale.restoreState(state)
            exact.append(np.array_equal(ale.getScreenRGB(), screen) and np.array_equal(ale.getAudio(), sound))
        assert exact == [True, False]

    def test_05_states_compare_their_sticky_action(self):
        equal = []
        for ale in pong():
            ale.setInt("max_num_frames_per_episode", 1)
            ale.loadROM(PONG)
            ale.act(0)
            state = ale.cloneState()
            ale.act(3)  # is refused, and held
            equal.append(state == ale.cloneState())
        assert equal == [False, True]

    @pytest.mark.needs_roms("tetris", "qbert")
    @pytest.mark.parametrize("game", ("tetris", "qbert"))
    def test_05_a_frame_that_is_open_goes_on(self, game):
        exact = []
        for ale in pong():
            ale.setFloat("repeat_action_probability", 0.0)
            ale.loadROM(racebeam.find_image(game))
            state = ale.cloneState()
            rams = [(ale.act(step), ale.getRAM().tobytes()) for step in range(8)]
            ale.restoreState(state)
            exact.append(rams == [(ale.act(step), ale.getRAM().tobytes()) for step in range(8)])
        assert exact == [True, False]

    def test_06_states_hash_as_they_compare(self):
        ours, theirs = pong()
        assert hash(ours.cloneState()) == hash(ours.cloneState())
        two = [theirs.cloneState() for _ in range(2)]
        assert two[0] == two[1] and hash(two[0]) != hash(two[1])
        assert not (ours.cloneState() == 3)  # noqa: SIM201
        with pytest.raises(TypeError):
            theirs.cloneState() == 3  # noqa: B015

    def test_07_copies_have_the_game(self):
        frames = []
        for module in (drop_in, ale_py):
            env = module.AtariEnv("pong")
            env.reset(seed=1)
            env.step(0)
            frames.append(copy.deepcopy(env).ale.getFrameNumber())
        assert frames == [4, 0]
        assert pickle.loads(pickle.dumps(pong()[0])).getInt("random_seed") == 7
        with pytest.raises(TypeError):
            pickle.dumps(pong()[1])

    def test_08_images_of_other_kinds(self):
        ale = drop_in.ALEInterface()
        ale.loadROM(pathlib.Path(PONG).read_bytes())
        assert ale.getGame() == "pong"
        ale.loadROM("builtin:updraft")
        assert ale.getGame() == "updraft"
        assert str(drop_in.roms.get_rom_path("pong")) == PONG

    def test_09_nothing_is_logged(self):
        script = "import {} as m; m.ALEInterface.setLoggerMode(m.LoggerMode.Info); m.ALEInterface().loadROM({!r})"
        assert in_process(script.format("racebeam.ale_py", PONG)).stderr == ""
        assert in_process(script.format("ale_py", PONG)).stderr != ""

    def test_10_SDL_is_absent(self):
        assert (drop_in.SDL_SUPPORT, ale_py.SDL_SUPPORT) == (False, True)
        ale = drop_in.ALEInterface()
        ale.setBool("display_screen", True)
        ale.loadROM(PONG)
        ale.setString("record_screen_dir", "/tmp")
        with pytest.raises(RuntimeError, match="record_screen_dir is '/tmp'"):
            ale.loadROM(PONG)

    def test_11_getters_know_their_type(self):
        ours, theirs = pong()
        assert (ours.getFloat("random_seed"), theirs.getFloat("random_seed")) == (-1.0, 7.0)

    def test_12_a_closed_environment(self):
        env = drop_in.AtariEnv("pong")
        env.close()
        with pytest.raises(Exception):  # noqa: B017
            env.reset()
        theirs = ale_py.AtariEnv("pong")
        theirs.close()
        theirs.reset()

    def test_13_many_environments_take_more(self):
        for autoreset in ("NextStep", "Disabled"):
            envs = drop_in.AtariVectorEnv("pong", 2, autoreset_mode=autoreset, life_loss="end", render_mode="rgb_array")
            envs.reset(seed=[3, 4])
            envs.reset(seed=np.int64(3))
            assert envs.render()[1].shape == (210, 160, 3)
            assert set(envs.step(np.zeros(2, np.int64))[4]) == {
                "env_id",
                "lives",
                "frame_number",
                "episode_frame_number",
            }
        with pytest.raises(ValueError):
            ale_py.AtariVectorEnv("pong", 2, autoreset_mode="Disabled")
        theirs = ale_py.AtariVectorEnv("pong", 2)
        for seed in ([3, 4], np.int64(3)):
            with pytest.raises(TypeError):
                theirs.reset(seed=seed)
        with pytest.raises(NotImplementedError):
            theirs.render()
        assert theirs.metadata is ale_py.AtariVectorEnv.metadata
        assert envs.metadata is not drop_in.AtariVectorEnv.metadata

    def test_14_many_environments_raise(self):
        both = [module.AtariVectorEnv("pong", 2) for module in (drop_in, ale_py)]
        for envs in both:
            envs.reset(seed=1)
            for actions in ([0, 0], np.zeros(3, np.int64), np.zeros(2, np.float32)):
                with pytest.raises(AssertionError):
                    envs.step(actions)
            for mask, error in (([True, False], TypeError), (np.array([True]), ValueError)):
                with pytest.raises(error):
                    envs.reset(options={"reset_mask": mask})
            with pytest.raises(ValueError):
                envs.reset(seed=np.array([1]))
            with pytest.raises(TypeError):
                envs.reset(seed="x")
        with pytest.raises(IndexError):
            both[0].step(np.array([0, 99]))
        with pytest.raises(gymnasium.error.Error):
            drop_in.AtariVectorEnv("pong", 2, stack_num=0)
        ale_py.AtariVectorEnv("pong", 2, stack_num=0)
        for envs in both:
            envs.close()
        with pytest.raises(gymnasium.error.ClosedEnvironmentError):
            both[0].step(np.zeros(2, np.int64))
        both[1].step(np.zeros(2, np.int64))

    def test_15_ALEVectorInterface_and_xla(self):
        for name in INTERNAL:
            assert not (hasattr(drop_in, name) or hasattr(drop_in._ale_py, name)), name
        ours, theirs = interfaces(3)
        for each in (ours, theirs):
            with pytest.raises(RuntimeError):
                each.reset([0], [4])
        ours.reset([0, 1, 2], [4, 5, 6])
        ours.send([0, 1, 2], [1.0] * 3)
        with pytest.raises(IndexError):
            ours.send([0, 99, 0], [1.0] * 3)
        ours.recv()
        with pytest.raises(racebeam.InvalidInput):
            drop_in.ALEVectorInterface(__file__, 2)

    def test_16_a_strength_is_finite(self):
        for radius in (np.nan, np.inf, -np.inf):
            action = np.array([radius, 0, 0], np.float32)
            ours, theirs = (module.AtariEnv("pong", continuous=True) for module in (drop_in, ale_py))
            many = drop_in.AtariVectorEnv("pong", 2, continuous=True)
            for env in (ours, theirs, many):
                env.reset(seed=1)
            with np.errstate(invalid="ignore"):
                theirs.step(action)
                with pytest.raises(racebeam.InvalidInput, match="must be a finite number"):
                    ours.step(action)
            with pytest.raises(racebeam.InvalidInput, match="must be a finite number"):
                many.step(np.array([action] * 2))
            with pytest.raises(racebeam.InvalidInput, match="must be a finite number"):
                ours.ale.act(0, radius)
        for env, action in (
            (ours, np.array([0, np.inf, 0], np.float32)),
            (many, np.array([[0, 0, 0], [0, 0, np.inf]], np.float32)),
        ):
            with pytest.raises(racebeam.InvalidInput, match="finite number"):
                env.step(action)

    def test_17_arguments_of_AtariEnv_are_checked(self, subtests):
        for arguments in (
            {"repeat_action_probability": 2},
            {"max_num_frames_per_episode": -5},
            {"frameskip": 2**31},
            {"continuous_action_threshold": "x"},
            {"continuous_action_threshold": float("nan"), "continuous": True},
        ):
            with subtests.test(**arguments):
                with pytest.raises(gymnasium.error.Error):
                    drop_in.AtariEnv("pong", **arguments)
                ale_py.AtariEnv("pong", **arguments)
        drop_in.AtariEnv("pong", frameskip=np.int64(4))
        with pytest.raises(gymnasium.error.Error):
            ale_py.AtariEnv("pong", frameskip=np.int64(4))

    @pytest.mark.parametrize(
        "arguments",
        (
            {"img_width": 321},
            {"img_height": 421},
            {"img_height": 8},
            {"stack_num": 17},
            {"noop_max": 1001},
            {"frameskip": 1001},
        ),
    )
    def test_18_limits_of_many_environments(self, arguments):
        with pytest.raises((gymnasium.error.Error, racebeam.InvalidInput)):
            drop_in.AtariVectorEnv("pong", 1, **arguments)
        ale_py.AtariVectorEnv("pong", 1, **arguments)

    def test_screens_that_grow_are_the_same(self):
        for size in ((224, 224), (256, 256), (420, 320), (84, 200), (211, 100)):
            settings = {"img_height": size[0], "img_width": size[1], "stack_num": 1}
            results = []
            for module in (drop_in, ale_py):
                envs = module.AtariVectorEnv("pong", 1, **settings)
                envs.reset(seed=1)
                results.append(np.stack([envs.step(np.array([step % 3]))[0] for step in range(10)]))
            assert np.array_equal(*results), size

    def test_19_no_frames(self):
        ours, theirs = (module.AtariVectorEnv("pong", 2, max_num_frames_per_episode=0) for module in (drop_in, ale_py))
        for envs, ends in ((ours, False), (theirs, True)):
            envs.reset(seed=1)
            for _ in range(5):
                assert envs.step(np.zeros(2, np.int64))[3].tolist() == [ends] * 2

    @pytest.mark.parametrize(
        ("settings", "sentence"),
        (
            ({"reward_min": 5, "reward_max": 1}, r"reward_min \(5\) is above reward_max \(1\)"),
            ({"paddle_min": 5000, "paddle_max": 100}, r"paddle_min \(5000\) must be between 0 and paddle_max \(100\)"),
            ({"frame_skip": -3}, "frame_skip is -3; it must be 1 or more"),
        ),
    )
    def test_20_settings_that_contradict_each_other(self, settings, sentence):
        ours, theirs = pong()
        for key, value in settings.items():
            ours.setInt(key, value)
            theirs.setInt(key, value)
        with pytest.raises(racebeam.InvalidInput, match=sentence):
            ours.loadROM(PONG)
        if "frame_skip" not in settings:  # with which ale_py hangs
            theirs.loadROM(PONG)
            theirs.act(0)
            assert theirs.getFrameNumber() == 1

    @pytest.mark.parametrize(("game", "rows"), (("seaquest", (210, 210)), ("carnival", (214, 210))))
    def test_21_an_unknown_image_with_the_name_of_a_game(self, game, rows, tmp_path):
        image = bytearray((package.SOURCE / "games/homebrew/beamfall.bin").read_bytes())
        image[image.index(b"\xff" * 64)] = 0  # between its program and its data
        (tmp_path / f"{game}.bin").write_bytes(image)
        both = pong()
        for ale in both:
            ale.loadROM(str(tmp_path / f"{game}.bin"))
        assert tuple(ale.getScreenDims()[0] for ale in both) == rows
        assert np.array_equal(*(ale.getRAM() for ale in both))
