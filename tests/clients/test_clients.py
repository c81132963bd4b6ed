"""The clients play over the line protocol, and decode every encoding."""

import importlib.util
import os
import re
import socket
import subprocess
import sys
import tempfile

import pytest

SOURCE = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path[:0] = [os.path.join(SOURCE, "tests", "server"), os.path.join(SOURCE, "clients", "python", "single_file")]

import client as racebeam  # noqa: E402
from harness import BINARY, GAME, PATIENCE, Server  # noqa: E402

ENCODINGS = ("hex", "rle", "delta", "base64", "zlib", "raw")
CONTENTS = {
    "ram": 128,
    "tia": 53,
    "state_hash": 8,
    "screen": 33600,
    "rgb": 100800,
    "grey": 33600,
    "grey84x3": 3 * 84 * 84,
    "palette": 768,
    "audio": 512,
}


@pytest.fixture(scope="module")
def server():
    with Server("serve", "--listen", "tcp://127.0.0.1:0", "--listen", "unix:s") as server:
        server.wait_for("listening on unix:s")
        yield server


@pytest.fixture(params=("stdio", "tcp", "unix"))
def session(request, server):
    """A client of a server, over standard streams, TCP and a Unix socket."""
    opened = {
        "stdio": lambda: racebeam.Session.start(BINARY),
        "tcp": lambda: racebeam.Session.tcp("127.0.0.1", server.port()),
        "unix": lambda: racebeam.Session.unix(server.path("s")),
    }
    with opened[request.param]() as session:
        yield session


class TestPythonClient:
    def test_every_encoding_says_the_same(self, session):
        session.load("beamfall", seed=3, frame_skip=4, sound=1)
        session.save("start", random=1)
        looks = []
        for encoding in ENCODINGS:
            session.observe("reward", "lives", *(f"{content}:{encoding}" for content in CONTENTS))
            session.restore("start")
            looks.append([session.act(action) for action in ("FIRE", "UP*3", "RIGHT", "FIRE*30", "NOOP")])
        for content, size in CONTENTS.items():
            assert {len(result[content]) for result in looks[0]} == {size}
        for others in looks[1:]:
            assert others == looks[0]
        assert looks[0][0]["screen"] != looks[0][3]["screen"]

    def test_the_palette_shows_the_screen(self, session):
        session.load("beamfall", seed=3)
        session.act("FIRE*30")
        shown, palette = session.look("screen", "rgb"), session.palette()
        assert b"".join(bytes(palette[value]) for value in shown["screen"]) == shown["rgb"]
        assert len(set(shown["screen"])) > 2

    def test_each_command_has_a_method(self, session):
        hello = session.hello()
        assert hello["server"].startswith("racebeam/")
        assert "act A" in session.help("act")
        assert "beamfall" in session.games()
        assert session.load("beamfall", seed=3, sticky=0, preset="paper2013")["frame_skip"] == 5
        assert session.settings()["seed"] == 3
        assert session.set(difficulty=1)["difficulty"] == 1
        assert (session.modes(), session.difficulties()) == ([0], [0, 1])
        bytes_of_ram, registers = session.names()
        assert (bytes_of_ram[1], registers[6], len(registers)) == ("lives", "COLUP0", len(session.look("tia")["tia"]))
        assert session.actions()[17] == "DOWNLEFTFIRE"
        assert session.observe("reward", "ends", "frame") == ["reward", "terminated", "truncated", "frame"]
        assert session.act("UP", "FIRE*2")["frame"] == 15
        session.poke(5, b"\x12\x34")
        assert session.peek(5, 2) == b"\x12\x34"
        assert len(session.look("screen", "lives")["screen"]) == 33600
        session.save("a")
        state = session.export_state("a")
        session.import_state("b", state)
        assert session.states() == ["a", "b"]
        session.drop("a")
        assert session.restore("b")["frame"] == 15
        branches = session.branch("b", ["FIRE*4", "UP"], [0], keep="leaf")
        assert [len(branch["rewards"]) for branch in branches] == [5, 1]
        assert branches[1]["state"] == "leaf1"
        assert len(session.open(3)) == 3
        assert [result["frame"] for result in session.step("UP", "FIRE", "NOOP")] == [5, 5, 5]
        session.save("c", machine=1, random=True)
        assert session.restore("c", machine=2)["frame"] == 5
        assert len(session.export_state("c", whole=True)) > len(session.export_state("c"))
        session.restart("010")
        session.close_machines()
        assert session.share("room", watchers=2) == {"share": "room", "watchers": 2}
        assert [shared["name"] for shared in session.shared()] == ["room"]
        frame = session.watch("room", "screen:delta")["frame"]
        assert len(session.watch("room", "screen:delta", "ram")["screen"]) == 33600
        assert "screen" not in session.watch("room", "screen", since=frame)
        session.unshare()
        assert session.reset()["reward"] == 0
        assert session.stats()["requests"] > 20
        session.quit()

    def test_a_refusal_has_a_code_and_leaves_the_session(self, session):
        with pytest.raises(racebeam.Refused) as caught:
            session.load("nothing")
        assert caught.value.code == "unknown-game"
        session.load("beamfall")

    def test_deltas_of_many_machines_are_told_apart(self, session):
        session.load("beamfall", seed=3, max_episode_frames=6)
        session.observe("ram:delta", "screen:delta", "ends")
        session.open(3, autoreset="same-step")
        plain = [session.step("UP", "DOWN", "FIRE") for _ in range(14)]
        session.observe("ram:hex", "screen:rle", "ends")
        session.open(3, autoreset="same-step")
        assert [session.step("UP", "DOWN", "FIRE") for _ in range(14)] == plain
        assert len(plain[5][0]["final_ram"]) == 128

    def test_an_image_can_be_sent(self):
        with open(os.path.join(SOURCE, "games", "homebrew", "updraft.bin"), "rb") as image:
            data = image.read()
        with racebeam.Session.start(BINARY) as session:
            assert session.load("inline", image=data)["game"] == "updraft"

    def test_requests_can_be_sent_ahead(self):
        with racebeam.Session.start(BINARY) as session:
            session.load("beamfall")
            session.observe("frame")
            for _ in range(100):
                session.send("act", "NOOP")
            assert [session.receive()[0]["frame"] for _ in range(100)] == [str(n) for n in range(1, 101)]


class TestFiles:
    """Addresses of the form file:PATH."""

    def refusal(self, kind, address):
        with pytest.raises(kind) as raised:
            racebeam.connect(address)
        return str(raised.value)

    def test_what_names_no_server_is_refused_in_a_sentence(self):
        tail = "; file:PATH takes the --ready-file or --announce file of a server"
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "file")
            for contents, reason in (
                (b"", f"is empty{tail}"),
                (b"dear diary\n", f"has other contents{tail}"),
                (b"\xff\x80\n", f"has other contents{tail}"),
                (b"{\xff\x80\n", "is not a whole announce file"),
                (b"{}", "is not a whole announce file"),
                (b"# addresses\nhttp://a:1\n", "names no address that this client can use"),
            ):
                with open(file, "wb") as written:
                    written.write(contents)
                assert self.refusal(ValueError, f"file:{file}") == f"{file} {reason}"
            os.mkfifo(os.path.join(folder, "pipe"))
            for path in (folder, os.path.join(folder, "pipe"), "/dev/zero"):
                for wait in ("", "?wait=60"):
                    assert self.refusal(ValueError, f"file:{path}{wait}") == f"{path} is not a regular file{tail}"
            for time in ("", "x", "-1", "1e3", "99999999999999999999"):
                assert (
                    self.refusal(ValueError, f"file:{file}?wait={time}")
                    == f"the address is 'file:{file}?wait={time}'; ?wait= takes seconds, from 0 to 999999999"
                )

    def test_a_server_that_is_gone_is_named_with_its_file(self):
        with tempfile.TemporaryDirectory() as folder, socket.socket() as taken:
            taken.bind(("127.0.0.1", 0))
            address = f"tcp://127.0.0.1:{taken.getsockname()[1]}"
            file = os.path.join(folder, "file")
            with open(file, "w") as written:
                written.write(f"# addresses\n{address}\n")
            assert (
                self.refusal(ConnectionRefusedError, f"file:{file}")
                == f"[Errno 111] no server answers at {address}, which {file} names: Connection refused"
            )


class TestRecordings:
    def test_a_file_is_there_when_it_is_whole_and_not_before(self):
        with Server("serve", "--stdio", "--record-dir", ".", streams=True) as server:
            session = racebeam.Session(server.process.stdout, server.process.stdin, lambda: None)

            def visible():
                return sorted(name for name in os.listdir(server.folder) if name[0] != "." and name != "stderr")

            session.load("beamfall", seed=1)
            for kind, name, head in (
                ("gif", "a.gif", b"GIF89a"),
                ("wav", "b.wav", b"RIFF"),
                ("y4m", "c.y4m", b"YUV4MPEG2"),
            ):
                before = visible()
                session.record(kind, name[0])
                session.act("FIRE*10")
                assert visible() == before
                assert session.stop_recording()["frames"] == 10
                assert visible() == before + [name]
                with open(server.path(name), "rb") as file:
                    assert file.read().startswith(head)
            session.record("png", "d")
            session.act("FIRE*10")
            session.save("root")
            session.branch("root", ["UP*50"])
            session.act("FIRE")
            session.stop_recording()
            assert sorted(os.listdir(server.path("d"))) == [f"{n:06}.png" for n in range(11)]
            with pytest.raises(racebeam.Refused):
                session.record("gif", "a")
            session.record("gif", "last")
            session.act("FIRE*10")
            server.process.stdin.close()  # the session's end keeps what there is
            server.wait()
            assert "last.gif" in visible()
            assert [name for name in os.listdir(server.folder) if name[0] == "."] == []

    def test_recording_changes_nothing_that_is_played(self):
        with Server("serve", "--stdio", "--record-dir", ".", streams=True) as server:
            session = racebeam.Session(server.process.stdout, server.process.stdin, lambda: None)
            session.load("beamfall", seed=1, sound=1)
            session.observe("reward", "screen", "audio", "ram")
            plain = [session.act("FIRE*7") for _ in range(10)]
            session.load("beamfall", seed=1, sound=1)
            session.record("wav", "a")
            assert [session.act("FIRE*7") for _ in range(10)] == plain


class TestExamples:
    def check(self, path, *words, says):
        done = subprocess.run(
            [os.path.join(SOURCE, "clients", path), *words], capture_output=True, timeout=PATIENCE * 5
        )
        assert done.returncode == 0, done.stderr
        assert re.search(says, done.stdout.decode())

    def test_they_play(self):
        self.check("python/random_agent.py", BINARY, GAME, says=r"^score \d+ in \d+ frames$")
        self.check("python/best_branch.py", BINARY, says=r"^score \d+ after \d+ frames, \d+ frames run$")
        self.check("shell/play-lines", BINARY, says=r"^Score \d+ in \d+ frames\.$")

    def test_a_wrong_program_and_a_wrong_game_get_a_sentence(self, subtests):
        for path, words, says in (
            (
                "best_branch.py",
                ("/nowhere", "beamfall"),
                "best_branch.py: /nowhere beamfall: .*No such file or directory",
            ),
            (
                "best_branch.py",
                (BINARY, "nogame"),
                "best_branch.py: .* nogame: unknown-game: unknown game 'nogame'",
            ),
            ("best_branch.py", ("/bin/true",), "best_branch.py: /bin/true beamfall: .*ended"),
            (
                "random_agent.py",
                ("/nowhere", GAME),
                "random_agent.py: cannot start /nowhere: No such file or directory; it takes",
            ),
            ("random_agent.py", (BINARY, "/nowhere.bin"), "racebeam: .*/nowhere.bin"),
            ("sarsa.py", ("/nowhere",), "sarsa.py: no server at /nowhere: .*No such file or directory"),
            ("sarsa.py", (BINARY, "nogame"), "sarsa.py: unknown-game: unknown game 'nogame'"),
            ("sarsa.py", ("tcp://127.0.0.1:1",), "sarsa.py: no server at tcp://127.0.0.1:1: .*Connection refused"),
            (
                "sarsa.py",
                ("udp://nowhere",),
                "sarsa.py: no server at udp://nowhere: the address is 'udp://nowhere'; it takes ",
            ),
            (
                "sarsa.py",
                (BINARY, "--background", "/nowhere.csv"),
                "sarsa.py: --background is '/nowhere.csv': .*; it takes 210 lines",
            ),
        ):
            if path == "sarsa.py" and importlib.util.find_spec("numpy") is None:
                continue
            with subtests.test(path=path, words=words):
                done = subprocess.run(
                    [sys.executable, os.path.join(SOURCE, "clients/python", path), *words],
                    capture_output=True,
                    text=True,
                    timeout=PATIENCE,
                )
                assert done.returncode == 1, done.stderr
                assert re.search(f"^(racebeam: the line protocol.*\n)?{says}[^\n]*\n$", done.stderr)

    @pytest.mark.parametrize(
        "path", ("python/random_agent.py", "python/best_branch.py", "shell/play-lines", "shell/play")
    )
    @pytest.mark.parametrize("words", ([], ["--help"]))
    def test_without_arguments_they_say_how_they_are_used(self, path, words):
        done = subprocess.run([os.path.join(SOURCE, "clients", path), *words], capture_output=True, timeout=PATIENCE)
        output = (done.stdout + done.stderr).decode()
        assert output.startswith("usage: " + os.path.basename(path)), output
        assert "Traceback" not in output
        assert done.returncode in ((0,) if words else (0, 2))
