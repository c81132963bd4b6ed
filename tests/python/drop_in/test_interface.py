"""ALEInterface of racebeam.ale_py returns and raises what that of ale_py does."""

import inspect
import pathlib
import pickle
import tempfile

import package
import pytest

package.require("ale_py", "gymnasium", "numpy")

import ale_py
import numpy as np
import racebeam
import racebeam.ale_py
from both import PONG, pong


class TestSettings:
    @pytest.mark.parametrize(
        ("kind", "keys"),
        (
            (
                "Int",
                "frame_skip max_num_frames max_num_frames_per_episode paddle_max paddle_min random_seed reward_max "
                "reward_min system_random_seed freq tiafreq volume fragsize",
            ),
            (
                "Bool",
                "color_averaging display_screen restricted_action_set run_length_encoding send_rgb sound sound_obs "
                "truncate_on_loss_of_life clipvol",
            ),
            ("Float", "repeat_action_probability"),
            ("String", "cpu palette record_screen_dir record_sound_filename rom_file"),
        ),
    )
    def test_they_begin_with_the_same_values(self, kind, keys):
        ours, theirs = racebeam.ale_py.ALEInterface(), ale_py.ALEInterface()
        for key in keys.split():
            assert getattr(ours, f"get{kind}")(key) == getattr(theirs, f"get{kind}")(key), key


@pytest.mark.needs_roms("pong")
class TestInterface:
    def outcome(self, call, ale):
        """What a call returns, or exactly which type it raises."""
        try:
            value = call(ale)
        except Exception as error:
            return type(error)
        if isinstance(value, np.ndarray):
            return value.dtype, value.shape, value.flags.writeable, value.flags.c_contiguous, value.tobytes()
        if isinstance(value, list) and value and hasattr(value[0], "name"):
            return [action.name for action in value]
        return type(value), value

    CALLS = [
        lambda ale: [ale.act(action % 18) for action in range(300)],
        lambda ale: ale.act(1, 0.5),
        lambda ale: ale.act(action=3, paddle_strength=0.25),
        lambda ale: ale.act("FIRE"),
        lambda ale: ale.act(-1),
        lambda ale: ale.act(1.0),
        lambda ale: ale.act(None),
        lambda ale: ale.getScreen(),
        lambda ale: ale.getScreenRGB(),
        lambda ale: ale.getScreenGrayscale(),
        lambda ale: ale.getRAM(),
        lambda ale: ale.getAudio(),
        lambda ale: ale.getScreenDims(),
        lambda ale: ale.getRAMSize(),
        lambda ale: ale.getAudioSize(),
        lambda ale: ale.lives(),
        lambda ale: ale.game_over(),
        lambda ale: ale.game_over(False),
        lambda ale: ale.game_over(with_truncation=True),
        lambda ale: ale.game_truncated(),
        lambda ale: ale.getFrameNumber(),
        lambda ale: ale.getEpisodeFrameNumber(),
        lambda ale: ale.getLegalActionSet(),
        lambda ale: ale.getMinimalActionSet(),
        lambda ale: ale.getAvailableModes(),
        lambda ale: ale.getAvailableDifficulties(),
        lambda ale: ale.setMode(99),
        lambda ale: ale.setMode(5),
        lambda ale: ale.setDifficulty(99),
        lambda ale: ale.setMode("x"),
        lambda ale: ale.setRAM(5, 77),
        lambda ale: ale.getRAM(),
        lambda ale: ale.setRAM(128, 0),
        lambda ale: ale.setRAM(-1, 0),
        lambda ale: ale.setRAM(0, 256),
        lambda ale: ale.setRAM(0, -1),
        lambda ale: ale.getScreenRGB(np.zeros((5, 5, 3), np.uint8)),
        lambda ale: ale.getScreenRGB(np.zeros((210, 160, 3), np.int32)),
        lambda ale: ale.getScreen(np.zeros((160, 210), np.uint8)),
        lambda ale: ale.getScreenGrayscale(np.zeros(3, np.uint8)),
        lambda ale: ale.getScreen(np.zeros((210, 320), np.uint8)[:, ::2]),
        lambda ale: ale.getRAM(np.zeros(5, np.uint8)),
        lambda ale: ale.getAudio(np.zeros(5, np.uint8)),
        lambda ale: ale.getRAM([0] * 128),
        lambda ale: ale.getRAM(buffer=np.zeros(128, np.uint8)),
        lambda ale: ale.getInt("random_seed"),
        lambda ale: ale.getInt("nonsense"),
        lambda ale: ale.getBool("nonsense"),
        lambda ale: ale.getFloat("nonsense"),
        lambda ale: ale.getString("nonsense"),
        lambda ale: ale.getInt("frame_skip"),
        lambda ale: ale.getInt("max_num_frames"),
        lambda ale: ale.getInt("max_num_frames_per_episode"),
        lambda ale: ale.getInt("system_random_seed"),
        lambda ale: ale.getInt("reward_min"),
        lambda ale: ale.getInt("reward_max"),
        lambda ale: ale.getFloat("repeat_action_probability"),
        lambda ale: ale.getBool("color_averaging"),
        lambda ale: ale.getBool("display_screen"),
        lambda ale: ale.getBool("sound"),
        lambda ale: ale.getBool("sound_obs"),
        lambda ale: ale.getBool("send_rgb"),
        lambda ale: ale.getBool("truncate_on_loss_of_life"),
        lambda ale: ale.getString("cpu"),
        lambda ale: ale.getString("record_screen_dir"),
        lambda ale: ale.getString("rom_file"),
        lambda ale: ale.setInt("nonsense", 1),
        lambda ale: ale.setBool("random_seed", True),
        lambda ale: ale.setInt("cpu", 1),
        lambda ale: ale.setFloat("random_seed", 1.0),
        lambda ale: ale.setString("nonsense", "x"),
        lambda ale: ale.setInt("frame_skip", "4"),
        lambda ale: ale.setFloat("repeat_action_probability", 0),
        lambda ale: ale.setInt("random_seed", np.int32(-5)),
        lambda ale: ale.isSupportedROM("/nowhere"),
        lambda ale: ale.isSupportedROM("/etc/hostname"),
        lambda ale: ale.isSupportedROM(PONG),
        lambda ale: ale.isSupportedROM(pathlib.Path(PONG)),
        lambda ale: ale.setLoggerMode(3.5),
        lambda ale: ale.reset_game(),
        lambda ale: ale.getFrameNumber(),
        lambda ale: ale.getEpisodeFrameNumber(),
        lambda ale: [ale.act(action % 6) for action in range(400)],
        lambda ale: ale.getScreenRGB(),
        lambda ale: ale.getAudio(),
    ]

    def test_all_calls_have_the_same_outcome(self, subtests):
        ours, theirs = pong()
        for number, call in enumerate(self.CALLS):
            with subtests.test(call=number, line=inspect.getsource(call).strip()[:60]):
                assert self.outcome(call, ours) == self.outcome(call, theirs)

    def test_buffers_are_filled(self):
        for ale in pong():
            for method, shape in (
                (ale.getScreen, (210, 160)),
                (ale.getScreenRGB, (210, 160, 3)),
                (ale.getScreenGrayscale, (210, 160)),
                (ale.getRAM, (128,)),
                (ale.getAudio, (512,)),
            ):
                buffer = np.full(shape, 99, np.uint8)
                assert method(buffer) is None
                assert np.array_equal(buffer, method())

    def test_settings_have_the_effect_that_they_have_in_ale(self, subtests):
        settings = (
            (),
            (("setInt", "frame_skip", 3),),
            (("setInt", "reward_max", 0),),
            (("setInt", "reward_min", 0),),
            (("setBool", "color_averaging", True),),
            (("setInt", "max_num_frames_per_episode", 50),),
            (("setFloat", "repeat_action_probability", 0.9),),
            (("setInt", "paddle_min", 100000), ("setInt", "paddle_max", 300000)),
            (("setInt", "system_random_seed", 5),),
        )
        for setting in settings:
            with subtests.test(settings=setting):
                results = []
                for ale in pong():
                    for setter, key, value in setting:
                        getattr(ale, setter)(key, value)
                    ale.loadROM(PONG)
                    rewards = [ale.act(step * 7 % 6) for step in range(1200)]
                    results.append(
                        (
                            rewards,
                            ale.getScreenRGB().tobytes(),
                            ale.getRAM().tobytes(),
                            ale.getAudio().tobytes(),
                            ale.game_truncated(),
                            ale.getFrameNumber(),
                        )
                    )
                assert results[0] == results[1]

    @pytest.mark.needs_roms("blackjack")
    def test_the_range_of_a_games_paddles_stays_for_the_images_after_it(self):
        results = []
        for ale in pong():
            ale.loadROM(racebeam.find_image("blackjack"))
            limits = [ale.getInt("paddle_max")]
            ale.loadROM(PONG)
            limits.append(ale.getInt("paddle_max"))
            results.append((limits, [(ale.act(4), ale.getRAM().tobytes()) for _ in range(40)]))
        assert results[0] == results[1]
        assert results[0][0] == [795000, 795000]

    def test_states_agree_on_what_is_played_after_them(self):
        results = []
        for ale in pong():
            rewards = [[ale.act(step % 6) for step in range(100)]]
            plain, system = ale.cloneState(), ale.cloneSystemState()
            rewards.append(
                (plain.getFrameNumber(), plain.getEpisodeFrameNumber(), plain.getDifficulty(), plain.getCurrentMode())
            )
            rewards.append((plain == ale.cloneState(), plain.equals(ale.cloneState(include_rng=False)), plain == plain))
            for state, restore in (
                (system, ale.restoreSystemState),
                (plain, ale.restoreState),
                (pickle.loads(pickle.dumps(system)), ale.restoreState),
            ):
                restore(state)
                rewards.append(
                    ([ale.act(step * 5 % 6) for step in range(100)], ale.getRAM().tobytes(), ale.getScreen().tobytes())
                )
            results.append(rewards)
        assert results[0] == results[1]

    def test_a_picture_is_the_same_file_to_a_reader(self):
        import struct
        import zlib

        def pixels(path):
            data = pathlib.Path(path).read_bytes()
            at, packed, head = 8, b"", b""
            while at < len(data):
                size, kind = struct.unpack(">I4s", data[at : at + 8])
                head, packed = (
                    (data[at + 8 : at + 8 + size], packed)
                    if kind == b"IHDR"
                    else (head, packed + data[at + 8 : at + 8 + size] if kind == b"IDAT" else packed)
                )
                at += size + 12
            rows = zlib.decompress(packed)
            width, height = struct.unpack(">II", head[:8])
            assert {rows[row * (3 * width + 1)] for row in range(height)} == {0}
            return head[:10], rows

        with tempfile.TemporaryDirectory() as folder:
            files = [f"{folder}/{number}.png" for number in range(2)]
            for ale, file in zip(pong(), files):
                ale.act(1)
                ale.saveScreenPNG(file)
            assert pixels(files[0]) == pixels(files[1])
