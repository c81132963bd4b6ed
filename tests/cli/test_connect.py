"""racebeam connect: a line client for people and for scripts."""

import fcntl
import functools
import os
import pathlib
import pty
import re
import select
import struct
import subprocess
import sys
import tempfile
import termios
import time
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "server"))

from harness import BINARY, PATIENCE, Server  # noqa: E402

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


class Piped(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.server = Server("serve", "--listen", "tcp://127.0.0.1:0", "--listen", "unix:s")
        cls.addClassCleanup(cls.server.__exit__)
        cls.address = f"tcp://127.0.0.1:{cls.server.port()}"

    def test_it_prints_replies_and_errors(self):
        done = connect(
            self.address, "load beamfall seed=7 sticky=0\n\n# a comment\nact 99\n  act FIRE*60 \nlook screen\n"
        )
        lines = done.stdout.splitlines()
        self.assertEqual((done.returncode, done.stderr, len(lines)), (0, "", 4))
        self.assertRegex(lines[1], r"^error bad-action '99' is not an action; ")
        self.assertEqual(lines[2], "ok reward=21 terminated=0 truncated=0 lives=4")
        self.assertGreater(len(lines[3]), 1000)  # whole, though it is long

    def test_the_address_may_be_in_the_environment(self):
        done = connect("", "hello\n", RACEBEAM_ADDRESS=f"unix:{self.server.path('s')}")
        self.assertRegex(done.stdout, r"^ok server=racebeam/\S+ protocol=1 ")

    def test_the_address_may_be_host_and_port(self):
        for host in ("127.0.0.1", "localhost"):
            done = connect(f"{host}:{self.server.port()}", "hello\n")
            self.assertRegex(done.stdout, r"^ok server=racebeam/\S+ protocol=1 ")
        self.assertIn("refused", connect("127.0.0.1:1", "hello\n").stderr)
        self.assertIn("tcp://127.0.0.1:1", connect("127.0.0.1:1", "hello\n").stderr)

    def test_without_an_address_it_says_so(self):
        done = connect("", "hello\n", RACEBEAM_ADDRESS="")
        self.assertIn("no address was given, and the variable RACEBEAM_ADDRESS is not set", done.stderr)

    def test_help_is_folded(self):
        lines = connect(self.address, "help settings\nhelp act\nhelp\nstats\n").stdout.splitlines()
        self.assertEqual(lines[0], "ok settings of load, as KEY=VALUE:")
        self.assertIn("  preset (none or a preset's name): a set of settings from the literature; other", lines)
        self.assertIn("      keys override it", lines)
        self.assertIn("  example: act FIRE RIGHT*10 3", lines)
        self.assertIn("  help COMMAND explains one", lines)
        self.assertEqual([line for line in lines if len(line) > 80 and not line.startswith("ok requests=")], [])
        self.assertRegex(lines[-1], "^ok requests=")

    def test_strict_ends_at_the_first_error(self):
        done = connect(self.address, "nonsense\nhello\n", "--strict")
        self.assertEqual((done.returncode, len(done.stdout.splitlines())), (1, 1))

    def test_quit_ends(self):
        self.assertEqual(connect(self.address, ":quit\nhello\n").stdout, "")

    def test_screen_shows_the_colours_of_rgb(self):
        done = connect(self.address, "load beamfall seed=7\nact FIRE*20\n:screen\n")
        rows = done.stdout.splitlines()[2:]
        self.assertEqual(len(rows), 26)  # 80 columns: a picture of 320 x 210 in cells of 1 x 2
        colours = set()
        for row in rows:
            self.assertTrue(row.endswith("\x1b[0m"))
            self.assertEqual(COLOUR.sub("", row), 80 * "\u2580" + "\x1b[0m")
            colours |= set(COLOUR.findall(row))
        self.assertIn(("0", "0", "0"), colours)
        self.assertGreater(len(colours), 5)

    def test_screen_without_a_game_is_refused(self):
        self.assertRegex(connect(self.address, ":screen\nhello\n").stdout, r"^error no-game .*\nok server=")

    def test_a_server_that_is_not_there_is_an_error(self):
        for address, sentence in (
            ("tcp://127.0.0.1:1", "refused"),
            ("unix:/nonexistent/s", "No such file"),
            ("nonsense", "it takes tcp://"),
        ):
            with self.subTest(address):
                done = connect(address, "hello\n")
                self.assertEqual((done.returncode, done.stdout), (1, ""))
                self.assertRegex(done.stderr, f"^racebeam: .*{sentence}.*\n$")

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
        self.assertEqual(client.returncode, 1, output)
        self.assertRegex(errors, "^racebeam: ")


class Tokens(unittest.TestCase):
    def test_a_token_file_admits(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder, "tokens")
            path.write_text(f"# who may\n{TOKEN}\n")
            path.chmod(0o600)
            with Server("serve", "--listen", "tcp://127.0.0.1:0", "--token-file", path) as server:
                address = f"tcp://127.0.0.1:{server.port()}"
                self.assertRegex(connect(address, "games\n", "--token-file", path).stdout, "^ok count=2 ")
                self.assertRegex(connect(address, "games\n").stdout, "^error unauthorized ")
                (pathlib.Path(folder) / "none").write_text("# nothing\n")
                done = connect(address, "games\n", "--token-file", f"{folder}/none")
                self.assertEqual(
                    (done.returncode, done.stderr), (1, f"racebeam: the token file {folder}/none has no token\n")
                )


class Encrypted(unittest.TestCase):
    """tls:// with our own certificates."""

    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.certificate, cls.key = cls.certified(folder.name, "own")
        cls.stranger, _ = cls.certified(folder.name, "stranger")
        cls.server = Server(
            "serve", "--listen", "tls://127.0.0.1:0", "--tls-cert", cls.certificate, "--tls-key", cls.key
        )
        cls.addClassCleanup(cls.server.__exit__)
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
        self.assertEqual((done.returncode, done.stdout), (1, ""))
        self.assertRegex(done.stderr, "^racebeam: .*\n$")
        return done.stderr

    def test_a_session_is_encrypted(self):
        requests = "load beamfall seed=7 sticky=0\nact FIRE*60\n:screen\n"
        done = connect(f"tls://127.0.0.1:{self.port}", requests, "--authorities", self.certificate)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(done.stdout.splitlines()[1], "ok reward=21 terminated=0 truncated=0 lives=4")
        self.assertEqual(len(done.stdout.splitlines()), 2 + 26)

    def test_a_certificate_that_is_not_trusted_is_refused(self):
        self.assertIn("certificate verify failed", self.check_refusal("127.0.0.1"))
        self.assertIn("certificate verify failed", self.check_refusal("127.0.0.1", "--authorities", self.stranger))

    def test_a_certificate_of_another_host_is_refused(self):
        self.assertIn("certificate verify failed", self.check_refusal("localhost", "--authorities", self.certificate))

    def test_authorities_that_cannot_be_read_are_refused(self):
        for path in ("/nonexistent/authorities.pem", self.key):
            with self.subTest(path):
                self.assertIn(path, self.check_refusal("127.0.0.1", "--authorities", path))

    def test_only_one_side_with_tls_is_an_error(self):
        with Server("serve", "--listen", "tcp://127.0.0.1:0") as plain:
            self.check_refusal("127.0.0.1", "--timeout", "5", port=plain.port())
        self.check_refusal("127.0.0.1", "--timeout", "5", scheme="tcp")


class Typed(unittest.TestCase):
    """On a terminal."""

    def setUp(self):
        self.server = Server("serve", "--listen", "tcp://127.0.0.1:0")
        self.addCleanup(self.server.__exit__)
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.state = folder.name

    def run_typed(self, *keys, columns=0):
        """What the terminal shows. Each of `keys` is typed after a prompt. columns: its width, if it is known."""
        words = [BINARY, "connect", f"tcp://127.0.0.1:{self.server.port()}"]
        child, terminal = pty.fork()
        if child == 0:
            if columns:
                fcntl.ioctl(0, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
            os.execve(BINARY, words, {**os.environ, "XDG_STATE_HOME": self.state, "TERM": "xterm"})
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
        self.assertEqual(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), 0, shown)
        return shown

    def wait_for_editor(self, terminal):
        """Wait until libedit reads single keys: what is typed earlier, the terminal itself shows as well."""
        until = time.monotonic() + PATIENCE
        while self.edits() and termios.tcgetattr(terminal)[3] & termios.ICANON:
            self.assertLess(time.monotonic(), until, "libedit never took over the terminal")
            time.sleep(0.001)

    def test_long_values_are_shortened(self):
        output = self.run_typed("load beamfall seed=7\n", "look screen\n", ":quit\n")
        self.assertRegex(output, r"ok screen=[0-9A-F]{20}\.\.\.\(\d+\)")

    def test_history_lasts(self):
        if not self.edits():
            self.skipTest("built without libedit")
        self.run_typed("games all\n", ":quit\n")
        output = self.run_typed("\x1b[A\x1b[A\n", ":quit\n")  # up, up, enter
        self.assertIn("ok count=", output)

    def test_a_command_is_completed(self):
        if not self.edits():
            self.skipTest("built without libedit")
        self.assertIn("error no-game", self.run_typed("difficul\t\n", ":quit\n"))

    def test_games_keys_fields_actions_and_states_are_completed(self):
        if not self.edits():
            self.skipTest("built without libedit")
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
            self.assertIn(reply, output)
        self.assertIn("racebeam> act FIRE/RIGHT", self.visible(output))
        self.assertNotIn("error", output)

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

    def test_what_the_server_refuses_is_not_completed(self):
        if not self.edits():
            self.skipTest("built without libedit")
        self.assertIn("error no-game", self.run_typed("act fi\t\n", ":quit\n"))

    def test_help_has_the_width_of_the_terminal(self):
        for columns in (50, 100):
            output = self.run_typed("help settings\n", ":quit\n", columns=columns)
            lines = [len(line) for line in output.replace("\r", "").splitlines() if line.startswith("  ")]
            self.assertLessEqual(max(lines), columns)
            self.assertGreater(max(lines), columns - 15)

    @staticmethod
    @functools.cache
    def edits():
        """Whether the program was built with libedit."""
        return b"libedit" in subprocess.run(["ldd", BINARY], capture_output=True).stdout


if __name__ == "__main__":
    unittest.main(verbosity=2)
