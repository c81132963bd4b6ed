"""Files that the user names, in all commands: anything but a regular file is refused at once."""

import os
import re
import signal
import subprocess

import pytest
from harness import BINARY, GAME, PATIENCE, Server

LISTEN = ("serve", "--listen", "tcp://127.0.0.1:0")
TLS = ("serve", "--listen", "tls://127.0.0.1:0")
STDIO = ("serve", "--stdio")

# Each command, the file at its end, and the exit status.
COMMANDS = (
    ((*STDIO, "--rom"), 1),
    ((*STDIO, "--classic", "--rom"), 1),
    ((*STDIO, "--rom", GAME, "--game-file"), 1),
    ((*STDIO, "--config"), 2),
    (("config", "--stdio", "--config"), 2),
    ((*LISTEN, "--token-file"), 1),
    ((*TLS, "--tls-key", "/dev/null", "--tls-cert"), 1),
    (("classic", "-game_controller", "fifo"), 1),
    (("trace", "--actions", "-", "--rom"), 1),
    (("trace", "--rom", GAME, "--actions"), 1),
    (("bench", "--rom"), 1),
)


@pytest.mark.usefixtures("self_subtests")
class TestRefused:
    @pytest.fixture(autouse=True)
    def set_up(self, tmp_path):
        self.folder = str(tmp_path)
        self.pipe = os.path.join(self.folder, "pipe")
        os.mkfifo(self.pipe)

    def run_racebeam(self, *words):
        done = subprocess.run(
            [BINARY, *words], stdin=subprocess.DEVNULL, capture_output=True, timeout=PATIENCE, cwd=self.folder
        )
        return done.returncode, done.stdout, done.stderr.decode().splitlines()

    def check(self, path, reason):
        for words, status in COMMANDS:
            with self.subtests.test(words=words):
                ended, output, errors = self.run_racebeam(*words, path)
                assert (ended, output, len(errors)) == (status, b"", 1), errors
                assert re.search(re.escape(path) + "'?: " + reason, errors[0])

    def test_a_pipe_that_nobody_writes_to(self):
        self.check(self.pipe, "this is a pipe, not a file")

    def test_a_link_to_a_pipe(self):
        os.symlink("pipe", os.path.join(self.folder, "link"))
        self.check("link", "this is a pipe, not a file")

    def test_a_device_without_an_end(self):
        self.check("/dev/zero", "this is a device, not a file")

    def test_a_directory(self):
        self.check(
            self.folder, "this is a directory, not a file|this folder has no game files; their names end in .toml"
        )

    def test_a_file_that_is_not_there(self):
        self.check("nothing", "no such file")

    def test_a_file_that_is_huge(self):
        path = os.path.join(self.folder, "huge")
        with open(path, "wb") as file:
            file.truncate(1 << 40)  # takes no room on the disk
        self.check(path, "larger than ")

    def test_a_path_of_images_that_is_not_a_folder(self, subtests):
        for words, expected, sentence in (
            (("roms", self.pipe), 1, "Not a directory"),
            ((*STDIO, "--roms", self.pipe), 4, "is not a folder"),
        ):
            with subtests.test(words=words):
                status, output, errors = self.run_racebeam(*words)
                assert (status, output, len(errors)) == (expected, b"", 1), errors
                assert sentence in errors[0]

    def test_the_configuration_of_a_classic_launcher_is_passed_over(self):
        os.mkfifo(os.path.join(self.folder, "ale.cfg"))
        status, _, errors = self.run_racebeam("classic", "-config", self.pipe, "-game_controller", "fifo", GAME)
        assert (status, len(errors)) == (0, 3), errors
        assert "ale.cfg: this is a pipe, not a file; it is ignored" in errors[0]
        assert f"{self.pipe}: this is a pipe, not a file; it is ignored" in errors[1]

    def test_a_hangup_does_not_wait_for_a_token_file_that_became_a_pipe(self):
        path = os.path.join(self.folder, "tokens")
        with open(path, "w") as file:
            file.write("0123456789abcdef\n")
        os.chmod(path, 0o600)
        with Server(*LISTEN, "--token-file", path) as server:
            server.wait_for("listening on")
            os.remove(path)
            os.mkfifo(path)
            server.process.send_signal(signal.SIGHUP)
            server.wait_for("tokens: this is a pipe, not a file; the old token file stays in use")
            assert server.stop() == 0
