"""Invalid command lines and images: one clear line on standard error, an exit status, and no game is
played."""

import gzip
import os
import re
import tempfile

import pytest
from harness import GAME, run

MACHINES = (("trace", "--actions", "-"), ("bench", "--frames", "1"))
LARGEST = 524288


class Case:
    def check_refusal(self, status, complaint, *words, data=b""):
        ended, printed, errors = run(*words, data=data)
        errors = [line for line in errors if "is not in the catalogue" not in line]  # a warning about any strange image
        assert (ended, len(errors)) == (status, 1), errors
        assert re.search("^racebeam: .*" + complaint, errors[0])
        return printed


class TestControlCharacters(Case):
    """A terminal would execute them. They are printed as bytes, and a message remains one line."""

    NAME = "red\x1b[31m\nnext\x9b1m"
    SHOWN = r"red\\x1b\[31m\\x0anext\\xc2\\x9b1m"

    @pytest.mark.parametrize(
        "status, words",
        (
            (1, ("trace", "--actions", "-", "--rom", NAME)),
            (1, ("trace", "--rom", GAME, "--actions", NAME)),
            (1, ("bench", "--rom", GAME, "--game-file", NAME)),
            (1, ("roms", NAME)),
            (2, ("config", "--stdio", "--config", NAME)),
            (2, ("serve", "--stdio", "--seed", NAME)),
            (2, ("serve", "--stdio", "--" + NAME)),
            (2, (NAME,)),
        ),
    )
    def test_in_what_was_given(self, status, words):
        self.check_refusal(status, self.SHOWN, *words)

    def test_in_a_warning_about_an_image(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, self.NAME + ".bin")
            with open(path, "wb") as file:
                file.write(bytes(range(256)) * 16)
            _, _, errors = run("trace", "--rom", path, "--actions", "-")
            assert len(errors) == 1, errors
            assert re.search(self.SHOWN, errors[0])


@pytest.mark.usefixtures("self_subtests", "self_folder")
class TestImages(Case):
    def image(self, data, name="x.bin"):
        path = os.path.join(self.folder, name)
        with open(path, "wb") as file:
            file.write(data)
        return path

    def refuses(self, path, complaint):
        for command, *words in MACHINES:
            with self.subtests.test(command=command):
                assert self.check_refusal(1, complaint, command, "--rom", path, *words) == b""

    def test_a_missing_image(self):
        self.refuses(os.path.join(self.folder, "missing.bin"), r"missing\.bin.*no such file")

    def test_a_folder_for_an_image(self):
        self.refuses(self.folder, "irectory")

    def test_an_empty_image(self):
        self.refuses(self.image(b""), r"x\.bin.*empty")

    def test_an_image_larger_than_any_cartridge(self):
        self.refuses(self.image(b"\xea" * (LARGEST + 1)), str(LARGEST))

    def test_a_gzip_file_that_inflates_to_more_than_any_cartridge(self):
        self.refuses(self.image(gzip.compress(b"\xea" * (LARGEST + 1)), "x.bin.gz"), str(LARGEST))

    def test_a_gzip_file_that_is_cut(self):
        whole = gzip.compress(os.urandom(4096))
        self.refuses(self.image(whole[: len(whole) // 2], "x.bin.gz"), r"x\.bin\.gz")

    def test_a_truncated_image_has_a_size_that_no_scheme_fits(self):
        self.refuses(self.image(b"\xea" * 3000), "3000")

    def test_a_built_in_that_does_not_exist(self):
        self.refuses("builtin:beamfal", "beamfal.*beamfall")


class TestOptions(Case):
    def test_an_unknown_game_is_answered_with_similar_names(self):
        for command, *words in MACHINES:
            self.check_refusal(1, "brekout.*breakout", command, "--rom", GAME, "--game", "brekout", *words)

    def test_a_mode_that_the_game_does_not_offer(self):
        for command, *words in MACHINES:
            self.check_refusal(1, "no mode 77; it offers 0", command, "--rom", GAME, "--mode", "77", *words)

    def test_a_difficulty_that_the_game_does_not_offer(self):
        for command, *words in MACHINES:
            self.check_refusal(1, "no difficulty 9; it offers 0", command, "--rom", GAME, "--difficulty", "9", *words)

    def test_flags_that_are_not_numbers(self, subtests):
        for command, *words in MACHINES:
            for option in ("--seed", "--frame-skip", "--sticky", "--mode", "--difficulty"):
                with subtests.test(command=command, option=option):
                    self.check_refusal(2, option + ".*many", command, "--rom", GAME, *words, option, "many")
        self.check_refusal(2, "--max-frames.*many", "trace", "--rom", GAME, "--actions", "-", "--max-frames", "many")
        self.check_refusal(2, "--frames.*many", "bench", "--rom", GAME, "--frames", "many")

    @pytest.mark.parametrize(
        "option, value",
        (
            ("--frame-skip", "0"),
            ("--frame-skip", "-4"),
            ("--frame-skip", "99999999999"),
            ("--sticky", "1.5"),
            ("--sticky", "nan"),
            ("--max-frames", "-1"),
            ("--seed", "-1"),
        ),
    )
    def test_numbers_that_are_out_of_range(self, option, value):
        self.check_refusal(2, option, "trace", "--rom", GAME, "--actions", "-", option + "=" + value)

    @pytest.mark.parametrize(
        "words",
        (
            ("--frame-skip", "1"),
            ("--sticky", "0"),
            ("--sticky", "1"),
            ("--seed", str((1 << 32) - 1)),
            ("--system-seed", "0"),
            ("--mode", "0"),
            ("--difficulty", "0"),
            ("--max-frames", "0"),
        ),
    )
    def test_numbers_at_their_limits(self, words):
        status, printed, errors = run("trace", "--rom", GAME, "--actions", "-", *words, data=b"0 1 2")
        assert (status, len(printed.splitlines()), errors) == (0, 4, [])

    def test_what_is_accepted_is_named(self):
        trace = ("trace", "--rom", GAME, "--actions", "-")
        self.check_refusal(2, "--sticky.*'1.5' is not a number from 0 to 1", *trace, "--sticky", "1.5")
        self.check_refusal(2, "'fast'; accepted: auto, interpreter and translator", *trace, "--cpu", "fast")

    def test_what_the_console_of_an_image_does_not_take(self, subtests):
        for command, *words in MACHINES:
            for option, value, reason in (
                ("--scheme", "BUS", "unsupported cartridge scheme 'BUS'"),
                ("--left", "mindlink", "joystick, paddles"),
                ("--right", "mouse", "joystick, paddles"),
                ("--format", "hd", "auto, ntsc, pal, pal60, secam"),
                ("--height", "99", "from 100 to 256"),
                ("--ystart", "51", "from 0 to 50"),
            ):
                with subtests.test(command=command, option=option):
                    self.check_refusal(2, option + ".*" + reason, command, "--rom", GAME, *words, option, value)
            self.check_refusal(
                1, "scheme F8 needs an image of at least 8192", command, "--rom", GAME, *words, "--scheme", "F8"
            )

    def test_what_is_missing_is_named(self):
        self.check_refusal(2, "--rom is required", "trace", "--actions", "-")
        self.check_refusal(2, "--actions is required", "trace", "--rom", GAME)
        self.check_refusal(2, "DIR is required", "roms")
        self.check_refusal(2, "OUT.png is required", "png")

    def test_an_unknown_option_is_answered_with_similar_names(self, subtests):
        for suggestion, given, *words in (
            ("--frames", "--frams", "bench", "--rom", GAME, "--frams"),
            ("--frame-skip", "--frameskip=4", "bench", "--rom", GAME, "--frameskip=4"),
            ("--max-states", "--max-state 3", "serve", "--stdio", "--max-state", "3"),
            ("--strict", "--stict", "connect", "tcp://127.0.0.1:1", "--stict"),
            ("--actions", "--action=-", "trace", "--rom", GAME, "--action=-"),
        ):
            with subtests.test(words=words):
                self.check_refusal(2, f"unknown argument: {given}; did you mean {suggestion}", *words)
        self.check_refusal(2, r"unknown argument: --colour \(see", "bench", "--rom", GAME, "--colour")

    def test_an_unknown_subcommand_is_answered_with_similar_names(self):
        self.check_refusal(2, r"unknown subcommand 'conect'; did you mean connect\? Accepted: serve, ", "conect")
        self.check_refusal(2, "unknown subcommand 'conquer'; ", "conquer")

    def test_unknown_words_are_named(self):
        self.check_refusal(2, "--faster", "bench", "--rom", GAME, "--faster")
        self.check_refusal(2, "some", "bench", "--rom", GAME, "--screen", "some")
        self.check_refusal(2, "", "conquer")
        self.check_refusal(2, "", *[])


class TestHelp:
    def test_every_subcommand_explains_itself_in_one_form(self, subtests):
        _, overview, _ = run("--help")
        summaries = overview.decode().partition("Subcommands:\n")[2].partition("\n\n")[0]
        for command, summary in re.findall(r"^  (\w+) +(.*)$", summaries, re.MULTILINE):
            with subtests.test(command=command):
                status, text, errors = run(command, "--help")
                assert (status, errors) == (0, [])
                first, usage, *lines = text.decode().splitlines()
                assert first == summary
                assert usage.startswith(f"Usage: racebeam {command} ")
                assert len(lines) > 8
                assert [line for line in lines if len(line) > 100] == []

    def test_help_is_a_word_too(self):
        assert run("help") == run("--help")
        assert run("help", "trace") == run("trace", "--help")

    def test_the_version_is_printed(self):
        status, text, errors = run("--version")
        assert (status, errors) == (0, [])
        assert re.search(r"^racebeam \d+\.\d+\.\d+\n$", text.decode())
