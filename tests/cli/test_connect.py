"""racebeam connect: a line client for people and for scripts."""

import contextlib
import fcntl
import functools
import os
import pathlib
import pty
import re
import select
import struct
import subprocess
import tempfile
import termios
import time

import pytest
from harness import BINARY, PATIENCE, Server

TOKEN = "0123456789abcdef"
COLOUR = re.compile(r"\x1b\[[34]8;2;(\d+);(\d+);(\d+)m")


def connect(address, text, *options, **variables):
    """A run whose input is a pipe."""
    return subprocess.run(
        [BINARY, "connect", *([address] if address else []), *options],
        input=text,
        capture_output=True,
        text=True,
        timeout=PATIENCE,
        env={**os.environ, **variables},
    )


class TestPiped:
    @pytest.fixture(scope="class", autouse=True)
    @classmethod
    def set_up_class(cls, request):
        cls.server = Server("serve", "--listen", "tcp://127.0.0.1:0", "--listen", "unix:s")
        request.addfinalizer(cls.server.__exit__)
        cls.address = f"tcp://127.0.0.1:{cls.server.port()}"

    def test_it_prints_replies_and_errors(self):
        done = connect(
            self.address, "load beamfall seed=7 sticky=0\n\n# a comment\nact 99\n  act FIRE*60 \nlook screen\n"
        )
        lines = done.stdout.splitlines()
        assert (done.returncode, done.stderr, len(lines)) == (0, "", 4)
        assert re.search(r"^error bad-action '99' is not an action; ", lines[1])
        assert lines[2] == "ok reward=21 terminated=0 truncated=0 lives=4"
        assert len(lines[3]) > 1000  # whole, though it is long

    def test_the_address_may_be_in_the_environment(self):
        done = connect("", "hello\n", RACEBEAM_ADDRESS=f"unix:{self.server.path('s')}")
        assert re.search(r"^ok server=racebeam/\S+ protocol=1 ", done.stdout)

    def test_the_address_may_be_host_and_port(self):
        for host in ("127.0.0.1", "localhost"):
            done = connect(f"{host}:{self.server.port()}", "hello\n")
            assert re.search(r"^ok server=racebeam/\S+ protocol=1 ", done.stdout)
        assert "refused" in connect("127.0.0.1:1", "hello\n").stderr
        assert "tcp://127.0.0.1:1" in connect("127.0.0.1:1", "hello\n").stderr

    @pytest.mark.parametrize("address", ("[::1]:1", "a.example.invalid:1", "0:1"))
    def test_a_host_may_be_a_name_or_in_brackets(self, address):
        done = connect(address, "hello\n")
        assert (done.returncode, done.stdout) == (1, "")
        assert f"tcp://{address}" in done.stderr

    @pytest.mark.parametrize(
        "address",
        (
            "localhost:",
            "host:12a",
            "host:a",
            ":1",
            "tcp:1",
            "tls:1",
            "a/b:1",
            "a?b:1",
            "[a/b]:1",
            "[::1]",
            "a:b:1",
            "a",
        ),
    )
    def test_other_texts_than_host_and_port_are_taken_as_they_are(self, address):
        done = connect(address, "hello\n")
        assert (done.returncode, done.stdout) == (1, "")
        assert f"the address is '{address}'; it takes tcp://HOST:PORT" in done.stderr

    @pytest.mark.parametrize(
        "address, reason", (("unix:1", "unix:1"), ("pipes:1", "1_out"), ("file:1", "cannot read 1"))
    )
    def test_a_path_may_be_a_number(self, address, reason):
        done = connect(address, "hello\n")
        assert (done.returncode, done.stdout) == (1, "")
        assert reason in done.stderr
        assert "tcp://" not in done.stderr

    def test_without_an_address_it_says_so(self):
        done = connect("", "hello\n", RACEBEAM_ADDRESS="")
        assert "no address was given, and the variable RACEBEAM_ADDRESS is not set" in done.stderr

    def test_help_is_folded(self):
        lines = connect(self.address, "help settings\nhelp act\nhelp\nstats\n").stdout.splitlines()
        assert lines[0] == "ok settings of load, as KEY=VALUE:"
        assert "  preset (none or a preset's name): a set of settings from the literature; other" in lines
        assert "      keys override it" in lines
        assert "  example: act FIRE RIGHT*10 3" in lines
        assert "  help COMMAND explains one" in lines
        assert [line for line in lines if len(line) > 80 and not line.startswith("ok requests=")] == []
        assert re.search("^ok requests=", lines[-1])

    def test_strict_ends_at_the_first_error(self):
        done = connect(self.address, "nonsense\nhello\n", "--strict")
        assert (done.returncode, len(done.stdout.splitlines())) == (1, 1)

    def test_quit_ends(self):
        assert connect(self.address, ":quit\nhello\n").stdout == ""

    def test_screen_shows_the_colours_of_rgb(self):
        done = connect(self.address, "load beamfall seed=7\nact FIRE*20\n:screen\n")
        rows = done.stdout.splitlines()[2:]
        assert len(rows) == 26  # 80 columns: a picture of 320 x 210 in cells of 1 x 2
        colours = set()
        for row in rows:
            assert row.endswith("\x1b[0m")
            assert COLOUR.sub("", row) == 80 * "\u2580" + "\x1b[0m"
            colours |= set(COLOUR.findall(row))
        assert ("0", "0", "0") in colours
        assert len(colours) > 5

    def test_blocks_of_a_screen_have_the_mean_colours_of_its_pixels(self):
        done = connect(self.address, "load beamfall seed=7\nact FIRE*20\nlook rgb:hex\n:screen\n")
        _, _, reply, *rows = done.stdout.splitlines()
        pixels = bytes.fromhex(reply.removeprefix("ok rgb="))
        for number, row in enumerate(rows):
            colours, blocks = {}, []
            for layer, *colour in re.findall("\x1b\\[(38|48);2;(\\d+);(\\d+);(\\d+)m|\u2580", row):
                if layer:
                    colours[layer] = tuple(map(int, colour))
                else:
                    blocks.append((colours["38"], colours["48"]))
            for column, block in enumerate(blocks):
                assert block == (self.mean(pixels, column, 2 * number), self.mean(pixels, column, 2 * number + 1))
            assert len(blocks) == 80

    @staticmethod
    def mean(pixels, column, half):
        """The mean colour of the part of a screen that half of a block shows, of 80 x 52 halves; rounded down."""
        down, across = range(half * 210 // 52, (half + 1) * 210 // 52), range(2 * column, 2 * column + 2)
        parts = [pixels[3 * (160 * y + x) :][:3] for y in down for x in across]
        return tuple(sum(part) // len(parts) for part in zip(*parts))

    def test_screen_without_a_game_is_refused(self):
        assert re.search(r"^error no-game .*\nok server=", connect(self.address, ":screen\nhello\n").stdout)

    @pytest.mark.parametrize(
        "address, sentence",
        (
            ("tcp://127.0.0.1:1", "refused"),
            ("unix:/nonexistent/s", "No such file"),
            ("nonsense", "it takes tcp://"),
        ),
    )
    def test_a_server_that_is_not_there_is_an_error(self, address, sentence):
        done = connect(address, "hello\n")
        assert (done.returncode, done.stdout) == (1, "")
        assert re.search(f"^racebeam: .*{sentence}.*\n$", done.stderr)

    def test_a_server_that_goes_is_an_error(self):
        with Server("serve", "--listen", "tcp://127.0.0.1:0", "--grace", "0") as server:
            client = subprocess.Popen(
                [BINARY, "connect", f"tcp://127.0.0.1:{server.port()}"],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                text=True,
            )
            client.stdin.write("hello\n")
            client.stdin.flush()
            client.stdout.readline()
            server.stop()
        output, errors = client.communicate("hello\nhello\n", timeout=PATIENCE)
        assert client.returncode == 1, output
        assert re.search("^racebeam: ", errors)


class TestTokens:
    def test_a_token_file_admits(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "tokens")
            path.write_text(f"# who may\n{TOKEN}\n")
            path.chmod(0o600)
            with Server("serve", "--listen", "tcp://127.0.0.1:0", "--token-file", path) as server:
                address = f"tcp://127.0.0.1:{server.port()}"
                assert re.search("^ok count=2 ", connect(address, "games\n", "--token-file", path).stdout)
                assert re.search("^error unauthorized ", connect(address, "games\n").stdout)
                (pathlib.Path(folder) / "none").write_text("# nothing\n")
                done = connect(address, "games\n", "--token-file", f"{folder}/none")
                assert (done.returncode, done.stderr) == (1, f"racebeam: the token file {folder}/none has no token\n")


class TestEncrypted:
    """tls:// with our own certificates."""

    @pytest.fixture(scope="class", autouse=True)
    @classmethod
    def set_up_class(cls, tmp_path_factory, request):
        folder = tmp_path_factory.mktemp("encrypted")
        cls.certificate, cls.key = cls.certified(str(folder), "own")
        cls.stranger, _ = cls.certified(str(folder), "stranger")
        cls.server = Server(
            "serve", "--listen", "tls://127.0.0.1:0", "--tls-cert", cls.certificate, "--tls-key", cls.key
        )
        request.addfinalizer(cls.server.__exit__)
        cls.port = cls.server.wait_for(r"listening on tls://127\.0\.0\.1:(\d+)$").group(1)

    @staticmethod
    def certified(folder, name):
        """A certificate for only 127.0.0.1, and its key."""
        paths = f"{folder}/{name}.pem", f"{folder}/{name}.key"
        subprocess.run(
            [
                "openssl",
                "req",
                "-x509",
                "-newkey",
                "ec",
                "-pkeyopt",
                "ec_paramgen_curve:prime256v1",
                "-nodes",
                "-days",
                "2",
                "-subj",
                f"/CN={name}",
                "-addext",
                "subjectAltName=IP:127.0.0.1",
                "-out",
                paths[0],
                "-keyout",
                paths[1],
            ],
            check=True,
            capture_output=True,
        )
        return paths

    def check_refusal(self, host, *options, scheme="tls", port=None):
        """What a run that gets no session says."""
        done = connect(f"{scheme}://{host}:{port or self.port}", "hello\n", *options)
        assert (done.returncode, done.stdout) == (1, "")
        assert re.search("^racebeam: .*\n$", done.stderr)
        return done.stderr

    def test_a_session_is_encrypted(self):
        requests = "load beamfall seed=7 sticky=0\nact FIRE*60\n:screen\n"
        done = connect(f"tls://127.0.0.1:{self.port}", requests, "--authorities", self.certificate)
        assert (done.returncode, done.stderr) == (0, "")
        assert done.stdout.splitlines()[1] == "ok reward=21 terminated=0 truncated=0 lives=4"
        assert len(done.stdout.splitlines()) == 2 + 26

    def test_a_certificate_that_is_not_trusted_is_refused(self):
        assert "certificate verify failed" in self.check_refusal("127.0.0.1")
        assert "certificate verify failed" in self.check_refusal("127.0.0.1", "--authorities", self.stranger)

    def test_a_certificate_of_another_host_is_refused(self):
        assert "certificate verify failed" in self.check_refusal("localhost", "--authorities", self.certificate)

    def test_authorities_that_cannot_be_read_are_refused(self, subtests):
        for path in ("/nonexistent/authorities.pem", self.key):
            with subtests.test(path):
                assert path in self.check_refusal("127.0.0.1", "--authorities", path)

    def test_only_one_side_with_tls_is_an_error(self):
        with Server("serve", "--listen", "tcp://127.0.0.1:0") as plain:
            self.check_refusal("127.0.0.1", "--timeout", "5", port=plain.port())
        self.check_refusal("127.0.0.1", "--timeout", "5", scheme="tcp")


class TestTyped:
    """On a terminal."""

    @pytest.fixture(autouse=True)
    def set_up(self, tmp_path, cleanup):
        self.server = Server("serve", "--listen", "tcp://127.0.0.1:0")
        cleanup(self.server.__exit__)
        self.folder = self.state = str(tmp_path)

    def run_typed(self, *keys, columns=0, **variables):
        """What the terminal shows. Each of `keys` is typed after a prompt. columns: its width, if it is known."""
        words = [BINARY, "connect", f"tcp://127.0.0.1:{self.server.port()}"]
        child, terminal = pty.fork()
        if child == 0:
            if columns:
                fcntl.ioctl(0, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
            os.chdir(self.folder)
            os.execve(BINARY, words, {**os.environ, "XDG_STATE_HOME": self.state, "TERM": "xterm", **variables})
        shown, waiting, until = "", list(keys), time.monotonic() + PATIENCE
        prompts = 1
        while time.monotonic() < until and select.select([terminal], [], [], PATIENCE)[0]:
            try:
                shown += os.read(terminal, 65536).decode()
            except OSError:  # it has ended
                break
            if waiting and shown.count("racebeam> ") >= prompts:
                self.wait_for_editor(terminal)
                text = waiting.pop(0)
                prompts = shown.count("racebeam> ") + 1
                os.write(terminal, text.encode())
        os.close(terminal)
        assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0, shown
        return shown

    def wait_for_editor(self, terminal):
        """Wait until libedit reads single keys: what is typed earlier, the terminal itself shows as well."""
        until = time.monotonic() + PATIENCE
        while self.edits() and termios.tcgetattr(terminal)[3] & termios.ICANON:
            assert time.monotonic() < until, "libedit never took over the terminal"
            time.sleep(0.001)

    def test_long_values_are_shortened(self):
        output = self.run_typed("load beamfall seed=7\n", "look screen\n", ":quit\n")
        assert re.search(r"ok screen=[0-9A-F]{20}\.\.\.\(\d+\)", output)

    @pytest.mark.usefixtures("libedit")
    def test_history_lasts(self):
        self.run_typed("games all\n", ":quit\n")
        output = self.run_typed("\x1b[A\x1b[A\n", ":quit\n")  # up, up, enter
        assert "ok count=" in output

    @pytest.mark.usefixtures("libedit")
    def test_the_folder_of_the_history_is_made(self):
        self.state = os.path.join(self.state, "state", "of programs")
        self.run_typed("games all\n", ":quit\n")
        assert "games\\040all" in pathlib.Path(self.state, "racebeam_history").read_text().splitlines()

    @pytest.mark.usefixtures("libedit")
    def test_the_history_of_a_user_with_a_home_is_in_it(self):
        self.run_typed("hello\n", ":quit\n", XDG_STATE_HOME="", HOME=self.state)
        assert pathlib.Path(self.state, ".local/state/racebeam_history").exists()

    @pytest.mark.usefixtures("libedit")
    @pytest.mark.parametrize("home", ("", "home"))
    def test_without_an_absolute_path_no_history_is_written(self, home):
        self.run_typed("hello\n", ":quit\n", XDG_STATE_HOME="state", HOME=home)
        assert os.listdir(self.folder) == []

    @pytest.mark.parametrize("typed", (True, False))
    def test_if_only_one_side_is_a_terminal_replies_are_whole_and_without_prompts(self, typed):
        address, requests = f"tcp://127.0.0.1:{self.server.port()}", "load beamfall seed=7\nlook ram\n"
        expected = connect(address, requests).stdout
        ours, theirs = pty.openpty()
        source, target = (theirs, subprocess.PIPE) if typed else (subprocess.PIPE, theirs)
        with subprocess.Popen([BINARY, "connect", address], stdin=source, stdout=target, text=True) as child:
            os.close(theirs)
            if typed:
                os.write(ours, f"{requests}:quit\n".encode())
            printed, _ = child.communicate(None if typed else requests, timeout=PATIENCE)
        if not typed:
            printed = self.rest_of(ours).replace("\r\n", "\n")
        os.close(ours)
        assert printed == expected

    @staticmethod
    def rest_of(terminal):
        """What a program has printed that has ended."""
        printed = b""
        with contextlib.suppress(OSError):
            while select.select([terminal], [], [], PATIENCE)[0]:
                printed += os.read(terminal, 65536)
        return printed.decode()

    @pytest.mark.usefixtures("libedit")
    def test_the_newest_thousand_lines_are_kept(self):
        self.run_typed("hello\n", ":quit\n")
        path = pathlib.Path(self.state, "racebeam_history")
        heading = path.read_text().splitlines()[0]
        path.write_text("\n".join([heading, *(f"act\\040{number}" for number in range(1200))]) + "\n")
        self.run_typed("stats\n", ":quit\n")
        lines = path.read_text().splitlines()[1:]
        assert len(lines) == 1000
        assert lines[-3:] == ["act\\0401199", "stats", ":quit"]

    @pytest.mark.usefixtures("libedit")
    def test_headings_of_help_are_not_completed(self):
        assert "commands: " not in self.visible(self.run_typed("comman\t\n", ":quit\n"))

    @pytest.mark.usefixtures("libedit")
    def test_a_command_is_completed(self):
        assert "error no-game" in self.run_typed("difficul\t\n", ":quit\n")

    @pytest.mark.usefixtures("libedit")
    def test_games_keys_fields_actions_and_states_are_completed(self):
        output = self.run_typed(
            "load beam\tseed=7 stic\t0 life_loss=rep\tpreset=dq\t\n",
            "act fi\t\n",
            "act FIRE/righ\t\n",
            "save here\n",
            "restore he\t\n",
            "help fie\t\n",
            "open 2 autoreset=sa\t\n",
            "observe screen:zl\t\n",
            ":quit\n",
        )
        for reply in (
            "sticky=0 mode=0",
            "life_loss=reported",
            "preset=dqn2015",
            "ok state=here",
            "ok fields of observe and look:",
            "ok machines=2 autoreset=same-step",
            "ok fields=screen",
        ):
            assert reply in output
        assert "racebeam> act FIRE/RIGHT" in self.visible(output)
        assert "error" not in output

    @pytest.mark.usefixtures("libedit")
    def test_shared_sessions_words_of_lists_and_choices_are_completed(self):
        output = self.run_typed(
            "load beamfall seed=7 sticky=0\n",
            "share somewhere\n",
            "watch some\tsince=0\n",
            "save here\n",
            "branch here FIRE,noo\t1,fi\t\n",
            "reset see\t9\n",
            "log inl\trole=bas\t\n",
            "observe no\t\n",
            ":hel\t\n",
            ":quit\n",
        )
        for line in (
            "watch somewhere since=0",
            "branch here FIRE,NOOP 1,FIRE",
            "reset seed=9",
            "log inline role=baseline ",
            "observe none ",
            ":help ",
        ):
            assert f"racebeam> {line}" in self.visible(output)
        assert "error" not in output

    @pytest.mark.usefixtures("libedit")
    def test_a_word_that_is_offered_twice_is_completed_like_others(self):
        output = self.run_typed("help state\t\n", ":quit\n")  # a command, and a subject of help
        assert "racebeam> help states \n" in self.visible(output)

    @staticmethod
    def visible(shown):
        """The lines as a terminal shows them: libedit goes back to a column, and writes over what is there."""
        rows = []
        for line in shown.replace("\x07", "").replace("\r", "\x1b[1G").split("\n"):
            row, at = "", 0
            for column, text in re.findall(r"(?:\x1b\[(\d+)G)?([^\x1b]*)", line):
                at = int(column) - 1 if column else at
                row = row[:at] + text + row[at + len(text) :]
                at += len(text)
            rows.append(row)
        return "\n".join(rows)

    @pytest.mark.usefixtures("libedit")
    def test_what_the_server_refuses_is_not_completed(self):
        assert "error no-game" in self.run_typed("act fi\t\n", ":quit\n")

    def test_help_has_the_width_of_the_terminal(self):
        for columns in (50, 100):
            output = self.run_typed("help settings\n", ":quit\n", columns=columns)
            lines = [len(line) for line in output.replace("\r", "").splitlines() if line.startswith("  ")]
            assert max(lines) <= columns
            assert max(lines) > columns - 15

    @staticmethod
    @functools.cache
    def edits():
        """Whether the program was built with libedit."""
        return b"libedit" in subprocess.run(["ldd", BINARY], capture_output=True).stdout

    @pytest.fixture
    def libedit(self):
        """Skips a test if the program was built without libedit."""
        if not self.edits():
            pytest.skip("built without libedit")
