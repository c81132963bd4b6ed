"""racebeam trace on our own game: the format of its lines, the sources of actions, and invalid actions."""

import gzip
import os
import re
import tempfile
import zlib

import pytest
from harness import GAME, run

PLAY = b"1 1 0 3 3 3 11 11 4 4 12 12 2 10 5 13\n" * 20


def trace(*words, data=PLAY):
    status, printed, errors = run("trace", "--rom", GAME, "--actions", "-", *words, data=data)
    return status, printed.decode().splitlines(), errors


def play(*words, data=PLAY):
    status, lines, errors = trace(*words, data=data)
    assert (status, errors) == (0, []), errors
    return lines


class TestLines:
    def test_the_first_line_is_the_reset_and_every_action_has_one(self):
        lines = play()
        assert re.search(r"^R \d+ [0-9a-f]{8} [0-9a-f]{8}$", lines[0])
        acts = [line for line in lines if line.startswith("A")]
        assert [line.split()[1] for line in acts] == PLAY.decode().split()
        for line in acts:
            assert re.search(r"^A \d+ -?\d+ [01] \d+ [0-9a-f]{8} [0-9a-f]{8}$", line)

    def test_ram_in_full_agrees_with_its_checksum(self):
        for line in play("--ram", "--audio"):
            words = line.split()
            checksum, hexadecimal = words[-4 if len(words) else 0], words[-1]
            assert re.search("^[0-9a-f]{256}$", hexadecimal)
            assert f"{zlib.crc32(bytes.fromhex(hexadecimal)):08x}" == checksum

    def test_audio_adds_one_checksum_and_changes_nothing_else(self):
        silent, audible = play(), play("--audio")
        assert silent == [line.rsplit(" ", 1)[0] for line in audible]
        assert len({line.split()[-1] for line in audible}) > 10

    def test_an_episode_that_is_over_is_followed_by_a_reset(self):
        lines = play("--max-frames", "10", data=b"0 " * 25)
        assert "".join(line[0] for line in lines) == "R" + "A" * 10 + "R" + "A" * 10 + "R" + "A" * 5
        assert [line.split()[3] for line in lines if line[0] == "A"] == (["0"] * 9 + ["1"]) * 2 + ["0"] * 5

    def test_the_same_seed_gives_the_same_run_and_another_one_does_not(self):
        once, again, other = (play("--sticky", "0.5", "--seed", seed) for seed in ("7", "7", "8"))
        assert once == again
        assert once != other

    def test_the_defaults_are_those_of_the_recordings(self):
        assert play() == play("--seed", "123", "--sticky", "0", "--frame-skip", "1", "--max-frames", "0")
        assert play("--sticky", "0.5") == play("--sticky", "0.5", "--seed", "123")

    def test_rules_are_those_of_ale_unless_others_are_asked_for(self):
        assert play() == play("--rules", "ale-0.12")
        assert play() == play("--rules", "fixed")  # nothing is wrong with our own game
        status, _, errors = trace("--rules", "ale-0.11")
        assert status == 2
        assert "--rules: unknown value 'ale-0.11'; accepted: ale-0.12 and fixed" in errors[0]

    def test_a_frame_skip_of_two_is_every_second_frame(self):
        every = [line.split()[-2:] for line in play(data=b"3 3 4 4 1 1 10 10 " * 10) if line[0] == "A"]
        skipped = [line.split()[-2:] for line in play("--frame-skip", "2", data=b"3 4 1 10 " * 10) if line[0] == "A"]
        assert skipped == every[1::2]

    def test_a_difficulty_costs_one_more_reset_and_changes_the_game(self):
        assert play() != play("--difficulty", "1")

    def test_the_console_of_an_image_can_be_set(self, subtests):
        assert play() == play("--scheme", "4K", "--left", "joystick", "--format", "ntsc", "--ystart", "34")
        for words in (("--left", "paddles"), ("--ystart", "50"), ("--height", "220"), ("--format", "pal")):
            with subtests.test(option=words[0]):
                assert play() != play(*words)

    def test_color_averaging_changes_screens_and_nothing_else(self):
        plain, blended = play(), play("--color-averaging")
        assert [line.split()[:-1] for line in plain] == [line.split()[:-1] for line in blended]
        assert plain != blended


class TestObservations:
    def test_counters_are_truncated_frame_and_episode_frame(self):
        lines = [line.split() for line in play("--counters", "--max-frames", "3", data=b"0 " * 5)]
        assert [(words[0], *map(int, words[-3:])) for words in lines] == [
            ("R", 0, 0, 0),
            ("A", 0, 1, 1),
            ("A", 0, 2, 2),
            ("A", 1, 3, 3),
            ("R", 0, 3, 0),
            ("A", 0, 4, 1),
            ("A", 0, 5, 2),
        ]

    def test_colors_stand_in_every_so_manieth_line(self):
        every, third = ([line.split() for line in play("--colors", count)] for count in ("1", "3"))
        for number, (words, some) in enumerate(zip(every, third)):
            assert re.search("^[0-9a-f]{8} [0-9a-f]{8}$", " ".join(words[-2:]))
            assert some[-2:] == (["-", "-"] if number % 3 else words[-2:])
            assert some[:-2] == words[:-2]
        assert play("--colors", "0") == play()

    def test_a_line_s_screen_in_full_agrees_with_its_checksums(self):
        lines = play("--colors", "1", "--screen-of", "7")
        assert [number for number, line in enumerate(lines) if line[0] == "S"] == [8]
        _, number, screen, rgb = lines[8].split()

        def crc(text):
            return f"{zlib.crc32(bytes.fromhex(text)):08x}"

        assert (number, len(screen), len(rgb)) == ("7", 2 * 160 * 210, 6 * 160 * 210)
        assert [crc(screen), crc(rgb)] == [lines[7].split()[-3], lines[7].split()[-2]]

    def test_the_screen_of_the_first_line_is_that_of_the_reset(self):
        reset, screen, *acts = play("--screen-of", "0", data=b"3")
        assert [reset, *acts] == play(data=b"3")
        assert screen.startswith("S 0 ")
        assert f"{zlib.crc32(bytes.fromhex(screen.split()[2])):08x}" == reset.split()[-1]

    def test_a_life_that_is_lost_ends_an_episode_if_asked_for(self):
        def lives(line):
            return int(line.split()[4])

        plain, truncated = (
            [line for line in play(*words, data=b"0 " * 6000) if line[0] == "A"]
            for words in ((), ("--truncate-on-life-loss",))
        )
        first = next(number for number, line in enumerate(plain) if lives(line) < lives(plain[0]))
        assert [line.split()[3] for line in plain[: first + 1]] == ["0"] * (first + 1)
        assert [line.split()[3] for line in truncated[: first + 1]] == ["0"] * first + ["1"]


class TestWrites:
    def test_a_byte_that_is_written_is_read_back(self):
        lines = play("--ram", data=b"1 1\nM 5 200\nM 127 3\n0 0\n")
        assert [line.split()[0] for line in lines] == list("RAAMMAA")
        before, first, second = (bytes.fromhex(line.split()[-1]) for line in lines[2:5])
        assert first == before[:5] + bytes([200]) + before[6:]
        assert second == first[:127] + bytes([3])
        assert lines[3].startswith("M 5 200 ") and lines[4].startswith("M 127 3 ")

    def test_the_first_byte_and_the_largest_value_can_be_written(self):
        lines = play("--ram", data=b"M 0 255\n0\nM 0 0\n0\n")
        assert [line.split()[:3] for line in lines if line[0] == "M"] == [["M", "0", "255"], ["M", "0", "0"]]

    def test_writes_and_strengths_are_taken_from_a_trace(self):
        lines = play("--ram", data=b"3@0.5 4@-0.25 3@1 3@0.333 3@1e-5\nM 9 7\n0\n")
        assert [line.split()[1] for line in lines if line[0] == "A"] == [
            "3@0.5",
            "4@-0.25",
            "3",
            "3@0.333",
            "3@1e-05",
            "0",
        ]
        assert play("--ram", data="\n".join(lines).encode()) == lines


class TestSources:
    def from_file(self, name, data):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, name)
            with open(path, "wb") as file:
                file.write(data)
            status, printed, errors = run("trace", "--rom", GAME, "--actions", path)
        assert (status, errors) == (0, [])
        return printed.decode().splitlines()

    def test_a_trace_gives_its_own_actions_back(self):
        lines = play()
        recorded = "\n".join(["# trace 1 rom=x frames=320", *lines, "S 0 00ff00ff"]).encode()
        assert self.from_file("x.trace", recorded) == lines
        assert self.from_file("x.trace.gz", gzip.compress(recorded)) == lines
        assert play(data=gzip.compress(recorded)) == lines

    def test_numbers_may_stand_on_lines_in_any_way(self):
        assert play(data=b"1 2\n\n 3\t4 \r\n5") == play(data=b"1\n2\n3\n4\n5\n")

    def test_the_last_byte_is_read_without_a_line_end_too(self):
        expected = play(data=b"3\n")
        for size in (1, 1 << 16, (1 << 16) + 1):
            assert play(data=b"3".rjust(size)) == expected

    def test_no_action_is_a_reset_alone(self):
        assert [line[0] for line in play(data=b"")] == ["R"]


class TestRefusals:
    def check_refusal(self, complaint, lines, data):
        status, printed, errors = trace(data=data)
        assert (status, len(printed), len(errors)) == (1, lines, 1), errors
        assert re.search("^racebeam: .*" + complaint, errors[0])

    def test_a_word_that_is_not_a_number(self):
        self.check_refusal("line 2: 'up' is not a number", 0, b"1 2\n3 up\n")
        self.check_refusal("line 1: '3.5' is not a number", 0, b"3.5\n")
        self.check_refusal("line 1: '99999999999' is not a number", 0, b"99999999999\n")
        self.check_refusal("line 2: the action is missing", 0, b"A 1 0 0\nA\n")

    def test_a_write_that_can_t_be_made(self):
        self.check_refusal("line 2: the index of a byte of RAM must be 0 to 127, not 128", 0, b"1\nM 128 0\n")
        self.check_refusal("line 1: the index of a byte of RAM must be 0 to 127, not -1", 0, b"M -1 0\n")
        self.check_refusal("line 1: the value of a byte must be 0 to 255, not 256", 0, b"M 1 256\n")
        self.check_refusal("line 1: 'M' requires an index and a value", 0, b"M 1\n")

    def test_a_strength_that_is_not_a_number(self):
        for word in (b"3@", b"3@x", b"3@nan", b"3@inf", b"3@1001"):
            self.check_refusal("line 1: .* is not a strength from -1000 to 1000", 0, word)
        self.check_refusal("line 1: '' is not a number", 0, b"@1")

    def test_a_strength_has_its_limits(self):
        lines = play(data=b"3@1000 3@-1000")
        assert [line.split()[1] for line in lines if line[0] == "A"] == ["3@1000", "3@-1000"]
        for word in (b"3@1000.5", b"3@-1000.5"):
            self.check_refusal("line 1: .* is not a strength from -1000 to 1000", 0, word)

    def test_a_word_is_shown_with_its_first_40_characters(self):
        self.check_refusal(f"line 1: '{'y' * 39}~' is not a number$", 0, b"y" * 39 + b"~")
        self.check_refusal(f"line 1: '{'y' * 40}' is not a number$", 0, b"y" * 41)
        self.check_refusal(r"line 1: '\?~!\?' is not a number$", 0, b"\x1b~!\x7f")

    def test_bytes_that_are_not_text(self):
        self.check_refusal("line 1: '.*' is not a number", 0, bytes(range(128, 160)))

    def test_a_mebibyte_without_a_line_end(self):
        self.check_refusal("line 1: .* is not a number", 0, b"1" * (1 << 20))

    @pytest.mark.parametrize("action", (b"18", b"25", b"39", b"41", b"99", b"2147483647"))
    def test_an_action_that_does_not_exist(self, action):
        self.check_refusal(r"line 3 .*" + re.escape(action.decode()), 3, b"1\n0\n" + action + b"\n0\n")

    def test_a_file_that_is_not_there(self):
        status, printed, errors = run("trace", "--rom", GAME, "--actions", "no-such-file")
        assert (status, printed, len(errors)) == (1, b"", 1), errors
        assert "no-such-file" in errors[0]

    def test_a_folder_for_a_file(self):
        status, printed, errors = run("trace", "--rom", GAME, "--actions", ".")
        assert (status, printed, len(errors)) == (1, b"", 1), errors
        assert "directory" in errors[0]

    @pytest.mark.slow
    def test_a_file_has_256_MiB_at_most_when_it_is_inflated(self):
        mebibyte = gzip.compress(b" " * (1 << 20))
        self.check_refusal("larger than 268435456 bytes$", 0, mebibyte * 256 + gzip.compress(b" "))

    def test_a_gzip_file_that_is_cut(self):
        self.check_refusal("unexpected end of file", 0, gzip.compress(os.urandom(200).hex().encode())[:-30])
