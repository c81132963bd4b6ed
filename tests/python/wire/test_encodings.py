"""Fields and encodings of replies, words of actions, and addresses in files."""

import base64
import json
import os
import pickle
import time
import zlib

import package
import pytest

package.require("numpy", "gymnasium")

import numpy as np
import racebeam
from racebeam.wire import addresses
from racebeam.wire.action_words import joystick_actions, joystick_words
from racebeam.wire.encodings import DECODERS, apply_delta, decode_rewards, decode_runs
from racebeam.wire.fields import SHAPES, field_encodings, field_shape
from racebeam.wire.observations import Observations
from racebeam.wire.stack import Stack


class TestFields:
    def test_fields_of_a_machine_have_its_shapes(self):
        assert {name: field_shape(name, 192) for name in SHAPES} == {
            "ram": (128,),
            "tia": (53,),
            "state_hash": (8,),
            "screen": (192, 160),
            "rgb": (192, 160, 3),
            "grey": (192, 160),
            "palette": (256, 3),
            "audio": (512,),
            "audio_all": (-1, 512),
        }

    def test_stacks_have_their_own_shapes(self):
        for field, shape in (
            ("grey84", (84, 84)),
            ("grey84x4", (4, 84, 84)),
            ("grey84x90x3", (3, 90, 84)),
            ("grey100x50x4", (4, 50, 100)),
            ("rgb100x50x4", (4, 50, 100, 3)),
            ("rgb84x84x1", (1, 84, 84, 3)),
        ):
            assert field_shape(field, 210) == shape

    def test_an_encoding_that_is_not_named_is_the_usual_one(self):
        fields = ("ram", "screen:delta", "grey84x4", "rgb10x20x1", "reward", "audio:raw", "rgb")
        assert field_encodings(fields) == {
            "ram": "hex",
            "screen": "delta",
            "grey84x4": "zlib",
            "rgb10x20x1": "zlib",
            "audio": "raw",
            "rgb": "zlib",
        }


class TestStack:
    def test_a_stack_is_that_of_the_last_screens(self):
        stack = Stack(3)
        assert [stack.push(screen) for screen in (b"ab", b"cd", b"ef", b"gh")] == [
            b"\0\0\0\0ab",
            b"\0\0abcd",
            b"abcdef",
            b"cdefgh",
        ]

    def test_a_cleared_stack_is_a_new_one(self):
        stack = Stack(2)
        stack.push(b"ab")
        stack.clear()
        assert stack.push(b"cd") == b"\0\0cd"

    @pytest.mark.needs_program
    def test_a_stack_of_the_client_is_that_of_the_server(self):
        with racebeam.launch() as one, racebeam.launch() as other:
            for session, field in ((one, "grey84x84x1:delta"), (other, "grey84x84x4")):
                session.load("beamfall", seed=1, frame_skip=4)
                session.observe(field)
            stack = Stack(4)
            for _ in range(2):
                stack.clear()
                for play in (lambda session: session.reset(), *[lambda session: session.act("FIRE")] * 6):
                    screen, screens = play(one)["grey84x84x1"], play(other)["grey84x84x4"]
                    assert stack.push(bytes(screen)) == bytes(screens)


class TestEncodings:
    def test_runs_are_a_value_and_a_length(self):
        assert decode_runs(b"") == b""
        assert decode_runs(bytes([7, 3, 9, 1, 0, 255])) == b"\7\7\7\t" + bytes(255)

    def test_every_encoding_gives_the_same_bytes(self):
        data = bytes([5, 5, 5, 1])
        texts = {
            "hex": "05050501",
            "rle": "05030101",
            "base64": base64.b64encode(data).decode(),
            "zlib": base64.b64encode(zlib.compress(data)).decode(),
            "raw": memoryview(data),
        }
        assert {name: DECODERS[name](text) for name, text in texts.items()} == dict.fromkeys(DECODERS, data)

    def test_a_delta_skips_bytes_and_fills_runs(self):
        array = bytearray(600)
        apply_delta(array, "")
        assert array == bytes(600)
        # 2 bytes on: two runs, 3 of 9 and 1 of 8. 0x0102 bytes on: a run of 2 of 7. To the last byte: 1 of 6.
        apply_delta(array, "00020209030801" + "0102010702" + "014D010601")
        assert bytes(array) == bytes(2) + b"\t\t\t\b" + bytes(0x0102) + b"\7\7" + bytes(0x014D) + bytes([6]) + bytes(
            600 - 2 - 4 - 0x0102 - 2 - 0x014D - 1
        )

    def test_a_delta_reaches_the_last_byte_and_not_further(self):
        array = bytearray(4)
        apply_delta(array, "0003010901")
        assert array == b"\0\0\0\t"
        for text, end in (("0003010902", 5), ("0004010901", 5), ("00020209020901", 5)):
            with pytest.raises(ValueError, match=f"a delta reaches byte {end} of 4"):
                apply_delta(array, text)
        with pytest.raises(IndexError):
            apply_delta(array, "0001020901")

    def test_rewards_of_a_branch_are_repeated(self):
        assert decode_rewards("0*3,1,-2*2") == [0, 0, 0, 1, -2, -2]
        assert decode_rewards("") == []


class TestObservations:
    def test_raw_fields_have_the_bytes_in_turn_and_all_of_them(self):
        observations = Observations(False)
        observations.follow(["observe", "ram:raw", "reward", "audio:raw"], {})
        for counts, good in ((("2", "1"), True), (("2", "0"), False), (("2", "2"), False)):
            groups = [{"ram": counts[0], "reward": "5", "audio": counts[1]}]
            if good:
                observations.split_bytes(["act"], groups, b"abc")
                assert observations.decode(["act"], groups) == [{"ram": b"ab", "reward": 5, "audio": b"c"}]
            else:
                with pytest.raises(ValueError):
                    observations.split_bytes(["act"], groups, b"abc")

    def test_deltas_begin_anew_with_a_game_and_with_other_fields(self):
        observations = Observations(False)
        change = [{"ram": "0001010901"}]
        first = bytes([0, 9]) + bytes(126)
        for words in (["observe", "ram:delta"], ["load", "pong"]):
            observations.follow(["observe", "ram:delta"], {})
            assert observations.decode(["act"], change) == [{"ram": first}]
            observations.decode(["act"], [{"ram": "0002010801"}])
            observations.follow(words, {"height": "192"})
            assert observations.decode(["act"], change) == [{"ram": first}]
        assert observations.height == 192
        observations.follow(["observe"], {})  # asks what is observed
        observations.follow(["act", "FIRE"], {})
        assert observations.decode(["act"], [{"ram": "0000010701"}]) == [{"ram": b"\7" + first[1:]}]

    def test_each_machine_has_deltas_of_its_own(self):
        observations = Observations(False)
        observations.follow(["observe", "ram:delta"], {})
        observations.decode(["act"], [{"ram": "0000010101"}])  # that of load
        observations.follow(["open", "2"], {})
        observations.decode(["step"], [{"machines": "2"}, {"ram": "0000010201"}, {"ram": "0000010301"}])
        same = "0001010901"
        for words, value in ((["act"], 1), (["restore", "a", "machine=0"], 2), (["restore", "a", "machine=1"], 3)):
            (values,) = observations.decode(words, [{"ram": same}])
            assert values["ram"][:2] == bytes([value, 9])
        observations.follow(["open", "1"], {})
        assert observations.decode(["restore", "a", "machine=0"], [{"ram": same}])[0]["ram"][:2] == b"\0\t"
        assert observations.decode(["restore", "a"], [{"ram": same}])[0]["ram"][:2] == b"\1\t"

    def test_fields_of_look_and_watch_are_those_of_the_request(self):
        observations = Observations(False)
        observations.follow(["observe", "ram"], {})
        assert observations.decode(["look", "ram:base64"], [{"ram": "AQI="}]) == [{"ram": b"\1\2"}]
        assert observations.decode(["look"], [{"ram": "0102"}]) == [{"ram": b"\1\2"}]
        words = ["watch", "mine", "since=5", "screen:delta"]
        texts = {"height": "1", "screen": "0001010901"}
        assert observations.decode(words, [texts]) == [{"height": 1, "screen": b"\0\t" + bytes(158)}]
        again = [{"height": "1", "screen": "0000010801"}]
        assert observations.decode(words, again)[0]["screen"][:2] == b"\b\t"
        assert observations.decode([*words, "ram"], again)[0]["screen"][:2] == b"\b\0"  # other fields


class TestWords:
    def test_a_direction_counts_beyond_the_threshold(self):
        half, more = np.float32(0.5), np.nextafter(np.float32(0.5), np.float32(1))
        for radius, angle, fire, action in (
            (half, 0, half, 0),
            (more, 0, half, 3),
            (more, np.pi, half, 4),
            (more, np.pi / 2, half, 2),
            (more, -np.pi / 2, half, 5),
            (half, np.pi, more, 1),
            (1, np.pi / 4, 0, 6),
            (1, 3 * np.pi / 4, 0, 7),
            (1, -np.pi / 4, 0, 8),
            (1, -3 * np.pi / 4, 0, 9),
            (1, np.pi / 2, 1, 10),
            (1, 0, 1, 11),
            (1, -np.pi, 1, 12),
            (1, -np.pi / 2, 1, 13),
            (1, np.pi / 4, 1, 14),
            (1, 3 * np.pi / 4, 1, 15),
            (1, -np.pi / 4, 1, 16),
            (1, -3 * np.pi / 4, 1, 17),
        ):
            joystick = np.array([[radius, angle, fire]], np.float32)
            actions, strengths = joystick_actions(joystick, 0.5)
            assert (actions.tolist(), strengths.tolist()) == ([action], [radius])
        assert joystick_words(joystick, 0.5) == ["17@1"]


class TestAddresses:
    @pytest.fixture(autouse=True)
    def set_up(self, tmp_path):
        self.path = tmp_path / "ready"

    def reach(self, text, wait=""):
        self.path.write_text(text)
        return addresses.reach(f"file:{self.path}{wait}", lambda address: f"opened {address}")

    @pytest.mark.needs_posix
    def test_the_first_address_that_a_client_can_use_is_opened(self):
        text = "# made by racebeam\nws://a:1\nunix:/b\ntcp://c:2\n"
        assert self.reach(text) == ("opened unix:/b", "unix:/b", None)
        announcement = {"racebeam_announce": 1, "addresses": ["wss://a:1", "tls://b:2"], "token": "abc"}
        assert self.reach(json.dumps(announcement)) == ("opened tls://b:2", "tls://b:2", "abc")

    @pytest.mark.needs_posix
    def test_a_file_of_others_is_refused(self):
        for text, sentence in (
            ("", "is empty; file:PATH takes"),
            ("hello\n", "has other contents; file:PATH takes"),
            ("# made\nws://a:1\n", "names no address that this client can use"),
            (json.dumps({"racebeam_announce": 1, "addresses": [], "token": None}), "names no address"),
            (json.dumps({"racebeam_announce": 2}), "is an announce file of version 2; this client reads version 1"),
            (json.dumps({"racebeam_announce": 1}), "is not a whole announce file"),
            ("{", "is not a whole announce file"),
        ):
            with pytest.raises(ValueError, match=f"ready {sentence}"):
                self.reach(text)
        os.mkfifo(self.path.with_name("pipe"))
        with pytest.raises(ValueError, match="pipe is not a regular file"):
            addresses.reach(f"file:{self.path.with_name('pipe')}", str)

    def test_the_environment_names_a_server(self, monkeypatch):
        monkeypatch.setenv("RACEBEAM_ADDRESS", "tcp://a:1")
        for address, opened in ((None, "tcp://a:1"), ("", "tcp://a:1"), ("tcp://b:2", "tcp://b:2")):
            assert addresses.reach(address, str) == (opened, opened, None)
        monkeypatch.delenv("RACEBEAM_ADDRESS")
        with pytest.raises(ValueError, match="the address is missing, and the variable RACEBEAM_ADDRESS is not set"):
            addresses.reach(None, str)

    def test_a_file_is_awaited_for_as_long_as_the_address_says(self, monkeypatch):
        now, tries = [100.0], []
        monkeypatch.setattr(time, "monotonic", lambda: now[0])
        monkeypatch.setattr(time, "sleep", lambda seconds: now.__setitem__(0, now[0] + seconds))

        def fail(address):
            tries.append(now[0] - 100)
            raise ConnectionRefusedError(111, "Connection refused")

        self.path.write_text("tcp://c:2\n")
        for wait, last in (("", 0), ("?wait=0", 0), ("?wait=2.5", 2.5), ("?wait=999999999", 999999999)):
            now[0], tries[:] = 100.0, []
            step = max(last / 4, 0.05)
            monkeypatch.setattr(addresses, "BETWEEN_TRIES", step)
            with pytest.raises(ConnectionRefusedError) as raised:
                addresses.reach(f"file:{self.path}{wait}", fail)
            assert tries == [part * step for part in range(5 if last else 1)]
            assert raised.value.strerror == (
                f"no server answers at tcp://c:2, which {self.path} names: Connection refused"
            )
            assert str(pickle.loads(pickle.dumps(raised.value))) == str(raised.value)  # from a worker process
        for wait in ("", "x", "-1", "1e3", "1000000000", "1."):
            with pytest.raises(ValueError, match="takes seconds, from 0 to 999999999"):
                addresses.reach(f"file:{self.path}?wait={wait}", str)
