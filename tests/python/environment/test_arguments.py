"""Arguments at the limits of what they take, and lost lives."""

import enum
import warnings

import package
import pytest

package.require("numpy", "gymnasium")

import numpy as np
import racebeam
from racebeam import InvalidInput, arguments
from racebeam.arguments import WrongType, WrongValue
from racebeam.single.actions import EnvWithActions
from racebeam.single.life_loss import LifeLoss

MOST = 2**31 - 1


class TestNumbers:
    def test_values_at_their_limits_are_taken_and_those_beyond_are_not(self):
        below, above = np.nextafter(0, -1), np.nextafter(1, 2)
        for check, good, bad in (
            (lambda value: arguments.integer("n", value, 3, 5), (3, 5, np.int64(4)), (2, 6)),
            (lambda value: arguments.optional_integer("n", value), (None, 0, MOST), (-1, MOST + 1)),
            (lambda value: arguments.share("n", value), (0, 1, 0.5), (below, above, float("nan"))),
            (lambda value: arguments.seconds("n", value), (None, 5e-324, MOST), (0, -1, MOST + 1, float("nan"))),
            (lambda value: arguments.real("n", value), (float("inf"), -1e308, 0), (float("nan"),)),
        ):
            for value in good:
                assert check(value) == value
            for value in bad:
                with pytest.raises(WrongValue, match="^n is "):
                    check(value)
            for value in ("x", [], object()):
                with pytest.raises(WrongType, match="^n is "):
                    check(value)

    def test_types_are_those_of_python(self):
        assert type(arguments.integer("n", np.int64(4), 3, 5)) is int
        for check in (arguments.share, arguments.real, arguments.seconds):
            assert type(check("n", np.float32(1))) is float
        assert type(arguments.flag("n", np.True_)) is bool


class TestWords:
    def test_an_old_name_is_taken_with_a_warning_but_not_with_the_new_one(self):
        with warnings.catch_warnings(record=True) as found:
            warnings.simplefilter("always")
            assert arguments.accept_old_name("old", None, "new", 0) == 0
            assert arguments.accept_old_name("old", None, "new", None) is None
            assert found == []
            assert arguments.accept_old_name("old", 0, "new", None) == 0
        assert [(str(one.message), one.category, one.filename) for one in found] == [
            ("old is the old name of new", DeprecationWarning, __file__)
        ]
        with pytest.raises(WrongValue, match="old is the old name of new; only one of them may be given"):
            arguments.accept_old_name("old", 0, "new", 0)

    def test_a_choice_is_a_word_or_is_left_out(self):
        for value in ("a", None):
            arguments.check_choice("n", value, ("a", None))
        for value in ("b", 0, False, "None", ""):
            with pytest.raises(WrongValue, match=f"n is {value!r}; it takes a, None"):
                arguments.check_choice("n", value, ("a", None))

    def test_a_member_is_named_in_lower_case(self):
        kind = enum.Enum("kind", ["FIRE_NOOPS", "NOOPS"])
        assert arguments.member("n", "fire-noops", kind) is kind.FIRE_NOOPS
        for word in ("FIRE_NOOPS", "fire_noops", None):
            with pytest.raises(WrongValue, match="it takes fire-noops, noops"):
                arguments.member("n", word, kind)

    def test_a_flag_or_a_word(self):
        spaces = ((True, "legal"), (False, "minimal"), (1, "legal"), ("console", "console"))
        assert [arguments.action_space("n", value) for value, _ in spaces] == [name for _, name in spaces]
        assert [arguments.sound_flag("n", value) for value in (True, 0, "all")] == [True, False, "all"]
        for check, word in ((arguments.action_space, "all"), (arguments.sound_flag, "console")):
            with pytest.raises(WrongValue, match=f"n is '{word}'; it takes True, False or "):
                check("n", word)
            with pytest.raises(WrongType, match="it takes True or False"):
                check("n", np.zeros(2))

    def test_names_that_are_near_are_suggested(self):
        arguments.check_names(["seed"], ("seed", "speed"), "help(f)")
        with pytest.raises(WrongType, match="unknown option 'sped'; did you mean speed or seed?"):
            arguments.check_names(["seed", "sped"], ("seed", "speed"), "help(f)")
        with pytest.raises(WrongType, match=r"unknown option 'x'; help\(f\) lists the options"):
            arguments.check_names(["x"], ("seed", "speed"), "help(f)")

    def test_the_console_has_the_settings_that_are_given(self):
        assert arguments.console_of(left="paddle", ystart=0, height=None) == {"left": "paddle", "ystart": "0"}
        assert (arguments.value_or(None, 5), arguments.value_or(0, 5)) == (5, 0)

    def test_a_game_has_one_source(self):
        for words in (("pong", None, None, None), (None, "rom", None, None), (None, "rom", "file", None)):
            arguments.check_source(*words)
        arguments.check_source("pong", "rom", None, "tcp://a:1")
        for words, sentence in (
            (("pong", "rom", "file", None), "give one of them"),
            ((None, "rom", "file", "tcp://a:1"), "game_file is given with server"),
            ((None, None, None, None), "game is None"),
            ((None, None, "file", None), "game is None"),
        ):
            with pytest.raises(WrongValue, match=sentence):
                arguments.check_source(*words)


class TestLives:
    class Machine:
        def __init__(self, limit=0, lives=3):
            self.limit, self.count = limit, lives

        def getInt(self, key):
            assert key == "max_num_frames_per_episode"
            return self.limit

        def lives(self):
            return self.count

    def test_a_lost_life_ends_the_episode_as_the_word_says(self):
        none = (False, False)
        for word, before, after, ends, found, continues in (
            ("ignored", 0, 2, none, (False, False), False),
            ("reported", 3, 2, none, (True, False), False),
            ("end", 3, 2, none, (True, False), True),
            ("end", 2, 1, none, (True, False), True),
            ("end", 1, 0, none, (False, False), False),  # the game is about to end
            ("end", 3, 3, none, (False, False), False),
            ("end", 3, 4, none, (False, False), False),
            ("end", 3, 2, (True, False), (True, False), False),
            ("end", 3, 2, (False, True), (True, True), False),
        ):
            life_loss = LifeLoss(word)
            assert not life_loss.continues
            assert life_loss.lives_before(self.Machine(lives=5)) == (0 if word == "ignored" else 5)
            assert life_loss.ends(self.Machine(), ends, before, after, 10) == found
            assert life_loss.continues == continues
        life_loss.continues = True
        life_loss.ends(self.Machine(), none, 3, 3, 10)
        assert not life_loss.continues

    def test_a_truncation_by_a_life_is_an_end_unless_the_limit_is_reached(self):
        life_loss = LifeLoss("restart")
        for limit, frame, found in (
            (0, 100, (True, False)),
            (101, 100, (True, False)),
            (100, 100, (False, True)),
            (1, 100, (False, True)),
        ):
            assert life_loss.ends(self.Machine(limit), (False, True), 0, 2, frame) == found
            assert life_loss.ends(self.Machine(limit), (False, False), 0, 2, frame) == (False, False)
        assert life_loss.ends(self.Machine(100), (True, True), 0, 2, 100) == (True, True)


class TestJoysticks:
    def env(self):
        env = EnvWithActions()
        env.continuous, env.continuous_action_threshold, env._two_player = True, 0.5, False
        return env

    def test_a_direction_counts_beyond_the_threshold(self):
        half, more = np.float32(0.5), np.nextafter(np.float32(0.5), np.float32(1))
        for radius, angle, fire, action in (
            (half, 0, half, 0),
            (more, 0, half, 3),
            (half, np.pi, more, 1),
            (1, np.pi, 0, 4),
            (1, np.pi / 2, 0, 2),
            (1, -np.pi / 2, 0, 5),
            (1, np.pi / 4, 1, 14),
            (1, -3 * np.pi / 4, 1, 17),
        ):
            joystick = np.array([radius, angle, fire], np.float32)
            assert self.env()._parse_action(joystick) == (action, float(radius), 18, 0.0)

    def test_a_joystick_has_a_radius_an_angle_and_a_button(self):
        space = racebeam.AtariEnv("beamfall", continuous=True).action_space
        assert (space.low.tolist(), space.high.tolist()) == (
            [0, -float(np.float32(np.pi)), 0],
            [1, float(np.float32(np.pi)), 1],
        )

    def test_keys_that_are_held_are_an_action(self):
        env = racebeam.AtariEnv("beamfall", full_action_space=True)
        keys = {env.get_action_meanings()[index]: held for held, index in env.get_keys_to_action().items()}
        assert (keys["NOOP"], keys["FIRE"], keys["UP"], keys["DOWN"]) == (("e",), (" ",), ("w",), ("s",))
        assert (keys["RIGHT"], keys["LEFT"]) == (("d",), ("a",))
        assert (keys["UPRIGHTFIRE"], keys["DOWNLEFT"]) == (("w", "d", " "), ("s", "a"))
        assert len(keys) == 18

    def test_an_index_is_one_of_the_actions(self):
        env = racebeam.AtariEnv("beamfall", full_action_space=True)
        assert [env._parse_action(index)[0] for index in (0, np.int64(17))] == [0, 17]
        for index in (-1, 18):
            with pytest.raises(IndexError, match=f"action {index} is out of range; accepted: 0 to 17"):
                env._parse_action(index)
        with pytest.raises(TypeError, match="action 1.0 has the type float; it must be an integer"):
            env._parse_action(1.0)

    def test_other_arrays_are_refused(self):
        for action in (np.zeros(3), np.zeros(2, np.float32), [0.0, 0.0, 0.0]):
            with pytest.raises(AssertionError, match="it must be a float32 array of 3"):
                self.env()._parse_action(action)
        with pytest.raises(InvalidInput, match="each part must be a finite number"):
            self.env()._parse_action(np.array([0, np.inf, 0], np.float32))

    def test_a_position_is_minus_1_0_or_1(self):
        assert EnvWithActions.map_action_idx(0, 0, False).name == "NOOP"
        assert EnvWithActions.map_action_idx(-1, -1, True).name == "DOWNLEFTFIRE"
        for words in ((2, 0), (0, 2), (-2, 0)):
            with pytest.raises(LookupError, match="each must be -1, 0 or 1"):
                EnvWithActions.map_action_idx(*words, False)
