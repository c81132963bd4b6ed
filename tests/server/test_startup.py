"""A start that fails prints its reason in one line, with an exit status and nothing on standard output."""

import hashlib
import os
import re
import resource
import subprocess
import tempfile

import pytest
from harness import BINARY, GAME, PATIENCE, SOURCE, WINDOWS, run, sanitized

SERVE = ("serve", "--classic", "--stdio", "--rom", GAME)
HOMEBREW = os.path.join(SOURCE, "games", "homebrew", GAME.split(":")[1] + ".bin")


class Refusals:
    def check(self, words, status, *hints):
        ended, output, errors = run(*words)
        assert (ended, output, len(errors)) == (status, b"", 1), errors
        assert errors[0].startswith("racebeam: "), errors
        for hint in hints:
            assert hint in errors[0]


@pytest.mark.needs_posix
class TestPipeNames(Refusals):
    def test_two_endpoints_cannot_have_the_same_pipes(self):
        with tempfile.TemporaryDirectory() as folder:
            pipes = f"pipes:{folder}/q"
            self.check(
                ["serve", "--listen", pipes, "--listen", pipes], 2, f"{pipes} can serve only one session: give it once"
            )
            assert os.listdir(folder) == []

    def test_pipes_in_a_folder_that_is_not_there_cannot_be_made(self):
        self.check(
            ["serve", "--pipes", "nowhere/q"], 3, "cannot make the pipe nowhere/q_out: No such file or directory"
        )

    def test_pipes_beside_another_file_of_their_name_are_not_made(self):
        with tempfile.TemporaryDirectory() as folder:
            with open(os.path.join(folder, "q_in"), "w"):
                pass
            self.check(["serve", "--pipes", f"{folder}/q"], 3, "q_in exists, but is not a named pipe")
            assert os.listdir(folder) == ["q_in"]


@pytest.mark.usefixtures("self_subtests")
class TestImages(Refusals):
    def check_image(self, data, *hints):
        """Every server refuses an image with these bytes, and creates nothing."""
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "pong.bin")
            with open(path, "wb") as image:
                image.write(data)
            self.check_path(path, *hints)
            assert os.listdir(folder) == ["pong.bin"]

    def check_path(self, path, *hints):
        transports = [["--stdio"], ["--listen", "tcp://127.0.0.1:0"]]
        if not WINDOWS:
            transports.append(["--pipes", path + "-pipe"])
        for transport in transports:
            with self.subtests.test(transport=transport[0]):
                self.check(["serve", "--classic", *transport, "--rom", path], 1, *hints)
        with self.subtests.test(transport="classic"):
            self.check(["classic", "-game_controller", "fifo", path], 1, *hints)

    def test_an_image_that_is_not_there_is_refused(self):
        self.check_path("nowhere/pong.bin", "nowhere/pong.bin")

    def test_an_empty_image_is_refused(self):
        self.check_image(b"", "empty")

    def test_an_image_that_is_too_large_is_refused(self):
        self.check_image(bytes(524289))
        self.check_image(bytes(5 << 20))

    def test_a_truncated_image_is_refused(self):
        with open(HOMEBREW, "rb") as image:
            self.check_image(image.read(1000))

    def test_a_folder_is_not_an_image(self):
        self.check(["serve", "--classic", "--stdio", "--rom", "/"], 1)

    def test_an_unknown_built_in_is_refused(self):
        self.check(["serve", "--classic", "--stdio", "--rom", "builtin:nothing"], 1, "nothing")

    def test_an_unknown_game_is_refused(self):
        self.check([*SERVE, "--game", "nothing"], 1, "nothing")

    def test_a_game_file_that_is_not_there_is_refused(self):
        self.check([*SERVE, "--game-file", "nothing.toml"], 1, "nothing.toml")

    def test_a_mode_that_is_not_offered_is_refused(self):
        self.check([*SERVE, "--mode", "99"], 1, "99")

    def test_a_difficulty_that_is_not_offered_is_refused(self):
        self.check([*SERVE, "--difficulty", "99"], 1, "99")


class TestCommandLine(Refusals):
    def refuse(self, *words, hint):
        self.check([*SERVE, *words], 2, hint)

    @pytest.mark.parametrize(
        "flag",
        (
            "--seed",
            "--system-seed",
            "--frame-skip",
            "--sticky",
            "--max-frames",
            "--max-episode-frames",
            "--mode",
            "--difficulty",
        ),
    )
    @pytest.mark.parametrize("value", ("fire", "", "1x", "0x10", " 1", "1,5"))
    def test_flags_that_are_not_numbers_are_refused(self, flag, value):
        self.refuse(flag, value, hint=flag)

    @pytest.mark.parametrize(
        "flag, value",
        (
            ("--seed", "-1"),
            ("--seed", "4294967296"),
            ("--frame-skip", "0"),
            ("--frame-skip", "-4"),
            ("--sticky", "1.01"),
            ("--sticky", "-0.1"),
            ("--sticky", "nan"),
            ("--sticky", "inf"),
            ("--max-frames", "-1"),
            ("--max-frames", "99999999999"),
            ("--max-episode-frames", "-1"),
        ),
    )
    def test_flags_that_are_out_of_range_are_refused(self, flag, value):
        self.refuse(flag, value, hint=f"'{value}' is not a")

    def test_a_flag_without_its_value_is_refused(self):
        self.refuse("--seed", hint="--seed")

    def test_an_unknown_flag_is_refused(self):
        self.refuse("--speed", "4", hint="unknown argument: --speed 4")

    def test_a_transport_is_needed(self):
        self.check(["serve", "--classic", "--rom", GAME], 2, "--stdio, --pipes PREFIX or --listen ADDRESS")
        self.refuse("--listen", "stdio", hint="stdio can serve only one session: give it once")

    @pytest.mark.parametrize(
        "words", (["--seed", "1"], ["--frame-skip", "4"], ["--sticky", "0"], ["--full-screen"], ["--mode", "0"])
    )
    def test_what_the_client_says_in_the_line_protocol_is_refused(self, words):
        self.check(["serve", "--stdio", "--rom", GAME, *words], 2, f"{words[0]}: requires --classic")

    def test_minus_zero_is_not_a_whole_number(self):
        self.check([*SERVE, "--seed=-0"], 2, "'-0' is not a whole number from 0 to 4294967295")
        lines = run("serve", "--stdio", data=b"load beamfall seed=-0\nload beamfall seed=0\n")[1].splitlines()
        assert lines[0].startswith(b"error bad-value seed is '-0'; it takes a whole number from 0 to "), lines
        assert lines[1].startswith(b"ok game=beamfall "), lines

    def test_folders_have_to_be_there(self):
        self.check(["serve", "--stdio", "--roms", "nowhere"], 4, "--roms nowhere is not a folder")
        self.check(["serve", "--stdio", "--record-dir", "nowhere"], 4, "--record-dir nowhere is not a folder")
        self.check([*SERVE, "--record-dir", "/tmp"], 2, "--record-dir")

    def test_memory_has_to_be_enough(self):
        self.check(["serve", "--stdio", "--max-memory", "1M"], 5, "--max-memory 1048576 is too little")

    @pytest.mark.needs_posix
    @pytest.mark.skipif(sanitized(), reason="a sanitizer needs more address space")
    def test_memory_that_the_system_does_not_give_has_the_same_status(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "tokens")
            with open(path, "w") as tokens:
                tokens.write("0123456789abcdef\n" * 900_000)  # 15 MB, and more for their digests
            os.chmod(path, 0o600)

            def limit():
                resource.setrlimit(resource.RLIMIT_DATA, (30 << 20, 30 << 20))

            done = subprocess.run(
                [BINARY, "serve", "--listen", "unix:s", "--threads", "1", "--token-file", path],
                capture_output=True,
                cwd=folder,
                timeout=PATIENCE,
                preexec_fn=limit,
            )
            assert (done.returncode, done.stderr) == (5, b"racebeam: the system gives no more memory\n")

    @pytest.mark.needs_posix
    @pytest.mark.skipif(sanitized(), reason="a sanitizer needs more address space")
    def test_a_thread_that_the_system_does_not_give_has_the_same_status(self, subtests):
        reason = "the system gives no more memory"  # for a thread, or for what a thread begins with
        for kibibytes in (20000, 26000):  # without room for the stack of a thread, or with hardly any

            def limit():
                resource.setrlimit(resource.RLIMIT_AS, (kibibytes << 10, kibibytes << 10))

            for form in ("text", "json"):
                with subtests.test(kibibytes=kibibytes, form=form):
                    done = subprocess.run(
                        [
                            BINARY,
                            "serve",
                            "--listen",
                            "tcp://127.0.0.1:0",
                            "--threads",
                            "2",
                            "--log-level",
                            "error",
                            "--log-format",
                            form,
                        ],
                        capture_output=True,
                        text=True,
                        timeout=PATIENCE,
                        preexec_fn=limit,
                    )
                    assert (done.returncode, done.stdout, done.stderr.count("\n")) == (5, "", 1), done.stderr
                    assert reason in done.stderr

    @pytest.mark.parametrize("size", ("-1", "99999999999999999999", "1.5G", "2x", "", "i", "G"))
    def test_a_limit_of_memory_is_a_size(self, size):
        self.check(
            ["serve", "--stdio", "--max-memory", size],
            2,
            (f"--max-memory: '{size}' is not a size; accepted: bytes, or 512M, 2G and the like, up to {1 << 60}"),
        )

    def test_an_image_has_to_be_named(self):
        self.check(["serve", "--classic", "--stdio"], 2, "--rom is required")

    def test_an_unknown_subcommand_is_answered_by_those_there_are(self):
        self.check(["emulate"], 2, "unknown subcommand 'emulate'", "serve, connect, play, watch, with, config, classic")
        self.check([], 2, "serve, connect, play, watch, with")


class TestFolders:
    """Files in the folder of --roms; unusable ones are skipped."""

    def games(self, prepare):
        with tempfile.TemporaryDirectory() as folder:
            prepare(lambda name: os.path.join(folder, name))
            status, output, errors = run("serve", "--stdio", "--roms", folder, data=b"games\nload my_own__game__1_\n")
            assert (status, len(errors)) == (0, 1), errors
            return output.decode().splitlines()

    def test_a_file_that_is_not_an_image_is_passed_over(self):
        def prepare(path):
            os.symlink("loop.bin", path("loop.bin"))
            os.symlink("nowhere.bin", path("dangling.bin"))
            os.mkdir(path("folder.bin"))
            os.mkfifo(path("pipe.bin"))
            for name, data in (("empty.bin", b""), ("large.bin", bytes(1 << 20)), ("cut.bin.gz", b"\x1f\x8b\x08")):
                with open(path(name), "wb") as file:
                    file.write(data)

        assert self.games(prepare)[0] == "ok count=2 games=beamfall,updraft"

    def test_the_name_of_an_unknown_image_means_nothing_else(self):
        with open(HOMEBREW, "rb") as image, tempfile.TemporaryDirectory() as folder:
            data = bytearray(image.read())
            names = ("inline", "all", hashlib.md5(data).hexdigest())  # the last is that of another image
            for place, name in enumerate(names):
                data[place] ^= 1
                with open(os.path.join(folder, name + ".bin"), "wb") as changed:
                    changed.write(data)
            requests = "".join(f"load {name}_\ngames {name}_\n" for name in names) + f"load {names[-1]}\n"
            status, output, errors = run("serve", "--stdio", "--roms", folder, data=requests.encode())
        lines = output.decode().splitlines()
        for name, loaded, described in zip(names, lines[::2], lines[1::2]):
            assert loaded.startswith(f"ok game={name}_ md5="), loaded
            assert described.startswith(f"ok game={name}_ here=1 "), described
        assert lines[-1].startswith("ok game=beamfall md5=" + names[-1]), lines[-1]
        assert status == 0, errors

    def test_the_name_of_an_unknown_image_is_a_word(self):
        def prepare(path):
            with open(HOMEBREW, "rb") as image, open(path("My own, game (1).bin"), "wb") as changed:
                changed.write(bytes(reversed(image.read())))

        listed, loaded = self.games(prepare)
        assert listed == "ok count=3 games=beamfall,my_own__game__1_,updraft"
        assert loaded.startswith("ok game=my_own__game__1_ md5="), loaded


@pytest.mark.needs_posix  # Wine's own files take the place of those that are closed
class TestDescriptors:
    @pytest.mark.parametrize("redirection, status", (("<&-", 0), (">&-", 1), ("2>&-", 0), ("<&- >&- 2>&-", 0)))
    def test_standard_ones_that_are_closed_are_not_taken_by_others(self, redirection, status):
        done = subprocess.run(
            ["bash", "-c", f"printf 'hello\\n' | '{BINARY}' serve --stdio {redirection}"],
            capture_output=True,
            timeout=PATIENCE,
        )
        assert done.returncode == status, done
        assert done.stdout.startswith(b"ok server=") == (redirection == "2>&-"), done


class TestHelp:
    def test_help_and_version_go_to_standard_output(self):
        for words, hint in (
            (["--version"], b"racebeam 0."),
            (["--help"], b"Try first"),
            (["serve", "--help"], b"Examples"),
        ):
            status, output, errors = run(*words)
            assert (status, errors) == (0, [])
            assert hint in output

    @pytest.mark.parametrize(
        "words", (["--help"], ["--version"], ["serve", "--help"], ["config"], ["roms", "."], ["games"])
    )
    def test_output_that_is_lost_is_a_failure(self, words):
        with open("/dev/full", "wb") as full:
            done = subprocess.run([BINARY, *words], stdout=full, stderr=subprocess.PIPE, timeout=PATIENCE)
            assert done.returncode == 1
            assert re.search(b"^racebeam: cannot write to standard output: .*\n$", done.stderr)

    def test_the_help_names_every_exit_status(self):
        for words in (["--help"], ["serve", "--help"]):
            text = b" ".join(run(*words)[1].split())
            for status in (b"0 ", b"1 ", b"2 ", b"3 ", b"5 ", b"255 "):
                assert status in text.split(b"Exit status:")[1]
