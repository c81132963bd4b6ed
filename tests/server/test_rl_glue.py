"""racebeam classic -game_controller rlglue is the environment of an RL-Glue 3.0 core. The core here is written from
docs/spec/classic-protocol.md, 11."""

import os
import socket
import struct
import subprocess

import pytest
from harness import BINARY, GAME, PATIENCE, run

SETTINGS = ("-random_seed", "1", "-repeat_action_probability", "0.25")
INIT, START, STEP, CLEANUP, MESSAGE, TERMINATE = 11, 12, 13, 14, 19, 35
SMALL, SMALL_SET = "builtin:updraft", [0, 1, 3, 4, 11, 12]  # a game with a minimal set
SCREEN = 160 * 210
ACTIONS = [1, 3, 3, 4, 0, 11, 12, 3, 99, -1] * 6
TASK = (
    b"VERSION RL-Glue-3.0 PROBLEMTYPE episodic DISCOUNTFACTOR 1 OBSERVATIONS INTS (128 0 255)%s ACTIONS INTS (0 %d) "
    b"REWARDS (UNSPEC UNSPEC) EXTRA Name: Arcade Learning Environment "
)


class Core:
    """An RL-Glue core with one environment, which is a process of ours."""

    def __init__(self, cleanup, *options, game=GAME):
        self.cleanup = cleanup
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.listener.settimeout(PATIENCE)
        self.cleanup(self.listener.close)
        self.environment = subprocess.Popen(
            [BINARY, "classic", "-game_controller", "rlglue", *SETTINGS, *options, game],
            stderr=subprocess.PIPE,
            text=True,
            env={**os.environ, "RLGLUE_PORT": str(self.listener.getsockname()[1])},
        )
        self.cleanup(self.environment.stderr.close)
        self.cleanup(self.environment.wait)
        self.cleanup(self.environment.kill)

    def accept(self):
        self.link, _ = self.listener.accept()
        self.link.settimeout(PATIENCE)
        self.stream = self.link.makefile("rb")
        self.cleanup(self.link.close)
        self.cleanup(self.stream.close)
        return struct.unpack(">2I", self.stream.read(8))

    def send(self, kind, payload=b""):
        self.link.sendall(struct.pack(">2I", kind, len(payload)) + payload)

    def ask(self, kind, payload=b""):
        self.send(kind, payload)
        answered, size = struct.unpack(">2I", self.stream.read(8))
        assert answered == kind, (answered, kind)
        return self.stream.read(size)

    def step(self, index):
        """Whether the episode is over, the reward, and the observation."""
        answer = self.ask(STEP, struct.pack(">3Ii", 1, 0, 0, index))
        return *struct.unpack(">id", answer[:12]), observation(answer[12:])

    def end(self):
        self.stream.close()
        self.link.close()
        return self.environment.wait(PATIENCE), self.environment.stderr.read().splitlines()


def observation(structure):
    """RAM and screen."""
    count, doubles, chars = struct.unpack(">3I", structure[:12])
    numbers = struct.unpack(f">{count}i", structure[12:])
    assert doubles == chars == 0
    return bytes(numbers[:128]), bytes(numbers[128:])


def lines_of_fifo(actions):
    """What the text protocol answers to a reset and these actions: for each the RAM, the screen, the end, the
    reward."""
    requests = b"1,1,0,1\n45,45\n" + b"".join(b"%d,18\n" % action for action in actions)
    words = ("-game_controller", "fifo", "-run_length_encoding", "false")
    status, output, errors = run("classic", *words, *SETTINGS, GAME, data=requests)
    assert status == 0, errors
    for line in output.splitlines()[2:-1]:
        ram, screen, episode, _ = line.split(b":")
        over, reward = episode.split(b",")
        yield bytes.fromhex(ram.decode()), bytes.fromhex(screen.decode()), int(over), int(reward)


@pytest.mark.usefixtures("self_cleanup")
class TestRlGlue:
    def start(self, *options, **more):
        core = Core(self.cleanup, *options, **more)
        assert core.accept() == (3, 0)
        return core

    def test_an_experiment_sees_what_a_client_of_the_text_protocol_sees(self):
        core = self.start()
        assert core.ask(INIT)[4:] == TASK % (b"(33600 0 127)", 18)
        # An index beyond the set is the first action.
        expected = list(lines_of_fifo([action if 0 <= action < 18 else 0 for action in ACTIONS]))
        assert observation(core.ask(START)) == expected[0][:2]
        for action, (ram, screen, over, reward) in zip(ACTIONS, expected[1:], strict=True):
            assert core.step(action) == (over, reward, (ram, screen))
        assert core.ask(CLEANUP) == b""
        assert core.ask(MESSAGE, struct.pack(">I5s", 5, b"hello")) == struct.pack(">I5s", 5, b"hello")
        core.send(TERMINATE)
        assert core.end()[0] == 0

    def test_a_start_is_a_reset(self):
        core = self.start("-repeat_action_probability", "0")
        first = [core.ask(START), *(core.step(3) for _ in range(20))]
        assert [core.ask(START), *(core.step(3) for _ in range(20))] == first

    def test_colours_and_the_minimal_set(self):
        plain = self.start(game=SMALL)
        core = self.start("-send_rgb", "true", "-restricted_action_set", "true", game=SMALL)
        assert core.ask(INIT)[4:] == TASK % (b"(100800 0 255)", len(SMALL_SET))
        indices = observation(plain.ask(START))[1]
        colours = observation(core.ask(START))[1]
        assert len(colours) == 3 * SCREEN
        pixels = {(index, colours[3 * at : 3 * at + 3]) for at, index in enumerate(indices)}
        assert len(pixels) == len(set(indices))  # each index has one colour
        for index, action in [*enumerate(SMALL_SET)] * 5:
            assert core.step(index)[2][0] == plain.step(action)[2][0]

    def test_the_limit_of_frames_ends_the_session(self):
        core = self.start("-max_num_frames", "5")
        core.ask(START)
        for _ in range(5):
            core.step(0)
        core.send(STEP, struct.pack(">3Ii", 1, 0, 0, 0))
        assert core.stream.read() == b""
        assert core.end()[0] == 0

    def test_an_episode_at_its_limit_stands_still_and_is_not_over(self):
        core = self.start("-max_num_frames_per_episode", "3")
        core.ask(START)
        steps = [core.step(3) for _ in range(6)]
        assert [over for over, _, _ in steps] == [0] * 6
        assert steps[3:] == steps[2:5]

    def test_a_core_that_comes_late_is_waited_for(self, cleanup):
        listener = socket.socket()
        cleanup(listener.close)
        listener.settimeout(PATIENCE)
        listener.bind(("127.0.0.1", 0))  # no other program gets the port, and nothing listens yet
        port = listener.getsockname()[1]
        environment = subprocess.Popen(
            [BINARY, "classic", "-game_controller", "rlglue", *SETTINGS, GAME],
            text=True,
            stderr=subprocess.PIPE,
            env={**os.environ, "RLGLUE_PORT": str(port)},
        )
        with environment:
            cleanup(environment.kill)
            waiting = next(line for line in environment.stderr if "waiting" in line)
            assert f"127.0.0.1:{port}" in waiting
            listener.listen()
            link, _ = listener.accept()
            with link:
                assert link.recv(8, socket.MSG_WAITALL) == struct.pack(">2I", 3, 0)
            assert environment.wait(PATIENCE) == 0

    def refuse(self, hint, kind, payload=b"", size=None):
        self.refuse_bytes(hint, struct.pack(">2I", kind, len(payload) if size is None else size) + payload)

    def refuse_bytes(self, hint, data):
        core = self.start()
        core.link.sendall(data)
        core.link.shutdown(socket.SHUT_WR)
        status, errors = core.end()
        assert status == 1
        assert hint in [line for line in errors if ": session: " not in line][-1]

    def test_what_the_protocol_does_not_have_is_refused_with_a_sentence(self):
        self.refuse("type 77", 77)
        self.refuse("without a whole number", STEP)
        self.refuse("without a whole number", STEP, struct.pack(">3I", 0, 0, 0))
        self.refuse("at most 1048576", STEP, size=0xFFFFFFFF)
        self.refuse("was lost: a payload is missing", STEP, size=16)

    def test_a_message_has_a_mebibyte_at_most(self):
        most = 1 << 20
        core = self.start()
        message = struct.pack(">I", most - 4).ljust(most, b"x")
        assert core.ask(MESSAGE, message) == message
        self.refuse(f"announced a payload of {most + 1} bytes; at most {most} are accepted", MESSAGE, size=most + 1)

    def test_a_core_that_leaves_in_the_middle_of_a_message_is_an_error(self):
        self.refuse("the connection to the RL-Glue core was lost: ", STEP, b"abc", size=16)
        self.refuse_bytes("the connection to the RL-Glue core was lost: ", struct.pack(">I", STEP))

    def test_a_port_and_a_screen_that_do_not_fit_are_refused(self):
        for port in ("0", "65536", "x"):
            environment = {**os.environ, "RLGLUE_PORT": port}
            done = subprocess.run(
                [BINARY, "classic", "-game_controller", "rlglue", GAME],
                env=environment,
                text=True,
                capture_output=True,
                timeout=PATIENCE,
            )
            assert done.returncode == 1
            assert f"RLGLUE_PORT is '{port}'" in done.stderr
