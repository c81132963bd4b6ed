"""racebeam classic accepts the command line of ALE 0.4 to 0.6, also as old launchers use it."""

import os
import shutil
import subprocess
import tempfile

import pytest
from harness import BINARY, GAME, PATIENCE, SOURCE, Server, open_pipes, run

IMAGE = os.path.join(SOURCE, "games", "homebrew", GAME.split(":")[1] + ".bin")
FIFO = ("-game_controller", "fifo", "-random_seed", "1", "-repeat_action_probability", "0")
PLAY = b"0,0,0,1\n" + b"3,18\n" * 20


@pytest.mark.usefixtures("self_folder")
class TestClassic:
    def put(self, name, text):
        with open(os.path.join(self.folder, name), "w") as file:
            file.write(text)
        return name

    def play(self, *words, data=PLAY):
        status, output, errors = run("classic", *words, data=data, cwd=self.folder)
        assert status == 0, errors
        assert output.startswith(b"160-210\n") and output.endswith(b"DIE\n"), output
        return output, errors

    def frames(self, *words):
        """How many data lines a session has before its limit of frames."""
        return self.play(*FIFO, *words)[0].count(b",0:\n")

    def refuse(self, *words, hint):
        status, output, errors = run("classic", *words, cwd=self.folder)
        assert (status, output, len(errors)) == (1, b"", 1), errors
        assert hint in errors[0]

    def test_a_session_on_standard_streams(self):
        assert self.play(*FIFO, GAME)[0] == b"160-210\n" + b"0,0:\n" * 21 + b"DIE\n"

    def test_options_that_nobody_knows_are_ignored(self):
        old = (
            "-disable_colour_averaging",
            "true",
            "-disable_color_averaging",
            "true",
            "-max_num_episodes",
            "0",
            "-player_agent",
            "keyboard_agent",
            "-use_environment_distribution",
            "-game_controller",
        )
        assert self.play(*old, *FIFO, GAME) == self.play(*FIFO, GAME)

    def test_words_after_the_image_are_ignored(self):
        assert self.frames("-max_num_frames", "5", GAME, "-max_num_frames", "7", "serve") == 5

    def test_options_for_windows_and_sound_are_mentioned(self):
        options = ("-display_screen", "true", "-record_sound_filename", "it.wav", "-sound", "false")
        errors = self.play(*FIFO, *options, GAME)[1]
        assert [line for line in errors if "ignored" in line] == [
            "racebeam: -display_screen is ignored",
            "racebeam: -record_sound_filename is ignored",
        ]

    def test_screens_are_recorded_as_numbered_pictures(self):
        os.mkdir(os.path.join(self.folder, "shots"))
        options = ("-record_screen_dir", "shots", "-frame_skip", "3")
        plain = self.play(*FIFO, *options[2:], GAME, data=b"1,0,0,1\n0,18\n3,18\n")[0]
        assert self.play(*FIFO, *options, GAME, data=b"1,0,0,1\n0,18\n3,18\n")[0] == plain
        # Two acts, and the one at the end of input.
        assert sorted(os.listdir(os.path.join(self.folder, "shots"))) == [f"{n:06}.png" for n in range(9)]
        for number, line in ((0, 1), (3, 2), (6, 3)):  # before an act: what the line before it showed
            screen = plain.split(b"\n")[line]
            run("png", "line.png", data=screen + b"\n", cwd=self.folder)
            with (
                open(os.path.join(self.folder, "line.png"), "rb") as expected,
                open(os.path.join(self.folder, f"shots/{number:06}.png"), "rb") as recorded,
            ):
                assert expected.read() == recorded.read(), number

    def test_a_folder_that_cannot_be_written_to_costs_the_pictures_alone(self):
        output, errors = self.play(*FIFO, "-record_screen_dir", "nowhere", GAME)
        assert output == self.play(*FIFO, GAME)[0]
        assert len([line for line in errors if "no further screen is recorded" in line]) == 1, errors

    def test_an_image_of_a_known_MD5_plays_under_any_name(self):
        shutil.copy(IMAGE, os.path.join(self.folder, "rom.bin"))
        assert self.play(*FIFO, "rom.bin") == self.play(*FIFO, GAME)

    def test_numbers_that_make_no_sense_are_refused(self, subtests):
        whole = f"it takes a whole number from 0 to {2**32 - 1}, or time"
        for key, value, hint in (
            ("random_seed", "-5", f"-random_seed is '-5'; {whole}"),
            ("random_seed", "now", whole),
            ("frame_skip", "x", f"-frame_skip is 'x'; it takes a whole number from {-(2**31)} to {2**31 - 1}"),
            ("frame_skip", "2.5", "'2.5'"),
            ("max_num_frames", "1e3", "'1e3'"),
            ("max_num_frames_per_episode", "99999999999", "'99999999999'"),
            ("repeat_action_probability", "often", "-repeat_action_probability is 'often'; it takes a number"),
        ):
            with subtests.test(key=key, value=value):
                self.refuse("-game_controller", "fifo", "-" + key, value, GAME, hint=hint)
        self.put("ale.cfg", "frame_skip = many\n")
        self.refuse(*FIFO, GAME, hint="-frame_skip is 'many'")
        assert (
            self.play("-game_controller", "fifo", "-random_seed", "time", "-frame_skip", "1", GAME)[0][:8]
            == b"160-210\n"
        )

    def test_a_program_called_ale_is_this_one(self):
        expected = self.play(*FIFO, GAME)[0]
        for name in ("ale", "racebeam-ale"):
            link = os.path.join(self.folder, name)
            os.symlink(BINARY, link)
            done = subprocess.run([link, *FIFO, GAME], input=PLAY, capture_output=True, timeout=PATIENCE)
            assert (done.returncode, done.stdout) == (0, expected), done.stderr
        beside = os.path.join(os.path.dirname(BINARY), "racebeam-ale")
        assert os.path.realpath(beside) == os.path.realpath(BINARY)

    def test_the_game_is_recognised_by_the_name_in_any_case(self):
        shutil.copy(IMAGE, os.path.join(self.folder, "BeamFall.A26"))
        errors = self.play(*FIFO, "BeamFall.A26")[1]
        assert errors == ["racebeam: beamfall, seed 1, on standard input and output"]

    def test_a_name_wins_over_the_MD5_with_a_warning(self):
        shutil.copy(IMAGE, os.path.join(self.folder, "PONG.bin"))
        errors = self.play(*FIFO, "PONG.bin")[1]
        assert len([line for line in errors if "MD5" in line]) == 1, errors
        assert "racebeam: pong, seed 1, on standard input and output" in errors

    def test_an_unknown_name_is_refused(self):
        with open(os.path.join(self.folder, "unheard_of.bin"), "wb") as image:
            image.write(b"\xea" * 4096)
        self.refuse(*FIFO, "unheard_of.bin", hint="unknown game 'unheard_of'")

    def test_limits_and_frame_skip(self):
        assert self.frames("-max_num_frames", "5", GAME) == 5
        assert self.frames("-max_num_frames", "5", "-frame_skip", "4", GAME) == 2
        for skip in ("0", "-3"):
            assert self.frames("-max_num_frames", "5", "-frame_skip", skip, GAME) == 5
        assert self.play(*FIFO, "-max_num_frames_per_episode", "3", GAME)[0].count(b"1,0:\n") == 18

    @pytest.mark.parametrize(
        "value, runs", (("1", True), ("true", True), ("True", False), ("0", False), ("yes", False))
    )
    def test_only_1_and_true_are_true(self, value, runs):
        output = self.play(*FIFO, "-run_length_encoding", value, GAME, data=b"1,0,0,0\n")[0]
        assert (len(output.split(b"\n")[1]) != 2 * 160 * 210 + 1) == runs

    def test_configuration_files_win_in_their_order(self):
        line = ("-max_num_frames", "5")
        self.put("ale.cfg", "max_num_frames = 3\n")
        assert self.frames(GAME) == 3
        assert self.frames(*line, GAME) == 5
        self.put("mine", "\n# limits\n  max_num_frames=7  \r\nnonsense\n")
        assert self.frames("-config", "mine", *line, GAME) == 7

    def test_a_configuration_that_is_not_there_is_done_without(self):
        assert self.frames("-config", "nothing", "-max_num_frames", "5", GAME) == 5

    def test_a_configuration_has_a_mebibyte_at_most(self):
        text = "max_num_frames = 7\n".ljust(1 << 20, "#")
        for name, contents, frames in (("fits", text, 7), ("large", text + "#", 5)):
            words = (*FIFO, "-config", self.put(name, contents), "-max_num_frames", "5", GAME)
            output, errors = self.play(*words)
            assert output.count(b",0:\n") == frames
            ignored = [line for line in errors if line.endswith("; it is ignored")]
            assert len(ignored) == (name == "large"), errors

    def test_help_with_two_hyphens_goes_to_standard_output(self):
        status, output, errors = run("classic", "--help", cwd=self.folder)
        assert (status, errors) == (0, [])
        assert b"-record_screen_dir FOLDER" in output

    def test_help_goes_to_standard_error_with_status_1(self):
        status, output, errors = run("classic", "-help", cwd=self.folder)
        assert (status, output) == (1, b"")
        assert "-game_controller" in "\n".join(errors)

    def test_a_controller_is_required(self):
        self.refuse(GAME, hint="-game_controller")
        self.refuse("-game_controller", "telepathy", GAME, hint="telepathy")

    def test_an_image_is_required(self):
        self.refuse(hint="the image is missing")
        self.refuse(*FIFO, hint="the image is missing")
        self.refuse(*FIFO, "-config", hint="-config has no value")
        self.refuse(*FIFO, "nothing.bin", hint="nothing.bin")


class TestNamedPipes:
    COMMAND = ("classic", "-game_controller", "fifo_named", *FIFO[2:], GAME)

    def test_two_sessions_on_pipes_that_the_client_made(self):
        with tempfile.TemporaryDirectory() as folder:
            for name in ("ale_fifo_out", "ale_fifo_in"):
                os.mkfifo(os.path.join(folder, name))
            for _ in range(2):
                with Server(*self.COMMAND, folder=folder) as server:
                    server.wait_for("for a client that opens ale_fifo_out")
                    wire = open_pipes(server, "ale_fifo")
                    wire.send(PLAY)
                    wire.stop_sending()
                    assert wire.rest() == b"160-210\n" + b"0,0:\n" * 21 + b"DIE\n"
                    wire.close()
                    assert server.wait() == 0

    def test_missing_pipes_end_the_server_as_they_ended_the_classic_one(self):
        with Server(*self.COMMAND) as server:
            assert server.wait() == 1
            assert "ale_fifo_in" in server.log()[-1]
            assert os.path.isfile(server.path("ale_fifo_out"))

    def test_a_file_in_the_place_of_a_pipe_stays(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "ale_fifo_out")
            with open(path, "w") as file:
                file.write("mine")
            with Server(*self.COMMAND, folder=folder) as server:
                assert server.wait() == 1
                assert "ale_fifo_out exists, but is not a named pipe" in server.log()[-1]
            with open(path) as file:
                assert file.read() == "mine"
