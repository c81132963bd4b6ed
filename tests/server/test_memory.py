"""A server with little memory: what it counts, whom it serves, whom it ends, and what it gives back."""

import os
import re
import socket
import tempfile
import threading
import time
import urllib.request

import pytest
from harness import PATIENCE, SOURCE, Wire, ask, connect_tcp, sanitized, serve, thread_sanitized

LONG = b"load beamfall as=tetris seed=1 sticky=0 max_episode_frames=0"
QUICK = 1 if PATIENCE <= 60 else PATIENCE / 20  # seconds, for a newcomer


def connect_from(address, port):
    """Connects from an address of this machine, which makes a client another owner of memory."""
    connection = socket.create_connection(("127.0.0.1", port), timeout=PATIENCE, source_address=(address, 0))
    connection.setblocking(True)
    return Wire(connection.fileno(), connection.fileno(), connection)


def ask_at_length(wire, line):
    """Asks as ask() does, for replies of a megabyte."""
    wire.send(line + b"\n")
    reply = b""
    while not reply.endswith(b"\n"):
        piece = wire.read(1 << 20)
        if not piece:
            raise AssertionError("the server closed its end")
        reply += piece
    return reply


def fill(wire, states=40):
    """Machines and states, as many as the server admits. Returns whether it has refused something, or ended the
    session."""
    lines = [
        LONG,
        b"observe grey84x4:hex",
        b"open 16",
        b"step NOOP",
        *[b"save s%d" % number for number in range(states)],
    ]
    try:
        return any([ask_at_length(wire, line).startswith((b"error limit ", b"error busy ")) for line in lines])
    except (AssertionError, OSError):
        return True


def write_images(folder, count):
    """Images of one game that differ in two bytes which the game never reads, so that each has its own code."""
    with open(os.path.join(SOURCE, "games/homebrew/beamfall.bin"), "rb") as file:
        image = file.read()
    unused = max(re.finditer(rb"(.)\1+", image, re.DOTALL), key=lambda found: len(found.group())).start()
    for number in range(count):
        with open(os.path.join(folder, f"image-{number}.bin"), "wb") as file:
            file.write(image[:unused] + (number + 1).to_bytes(2, "big") + image[unused + 2 :])


class Bystander:
    """A session that plays all the time. Whatever it gets but `ok` is a failure."""

    def __init__(self, port):
        self.wire = connect_tcp(port)
        self.replies = {ask(self.wire, b"load beamfall seed=1 max_episode_frames=0")[:2]}
        self.ends = threading.Event()
        self.thread = threading.Thread(target=self.play, daemon=True)
        self.thread.start()

    def play(self):
        try:
            while not self.ends.wait(0.005):
                self.replies.add(ask(self.wire, b"act RIGHT")[:2])
        except (AssertionError, OSError):
            self.replies.add(b"the end")

    def close(self):
        self.ends.set()
        self.thread.join()
        self.wire.close()
        return self.replies


@pytest.mark.skipif(sanitized() or thread_sanitized(), reason="a sanitizer needs more memory")
@pytest.mark.usefixtures("self_cleanup")
class TestMemory:
    def start(self, *options):
        self.server = serve("--threads", "2", "--http", "127.0.0.1:0", *options)
        self.cleanup(self.server.__exit__)
        self.http = int(self.server.wait_for(r"health and metrics on http://127\.0\.0\.1:(\d+)$").group(1))
        return self.server.port()

    def connect(self, port, address="127.0.0.1"):
        wire = connect_from(address, port)
        self.cleanup(wire.close)
        return wire

    def memory(self, kind):
        """The memory, in MiB."""
        with urllib.request.urlopen(f"http://127.0.0.1:{self.http}/metrics") as page:
            text = page.read().decode()
        return int(re.search(rf'^racebeam_memory_bytes{{kind="{kind}"}} (\d+)$', text, re.MULTILINE).group(1)) / (
            1 << 20
        )

    def check_newcomers(self, port, count=5, address="127.0.0.1"):
        """Each connects, loads a game and plays, and has done so within a second."""
        for _ in range(count):
            start = time.monotonic()
            wire = connect_from(address, port)
            for line in (b"load beamfall", b"act FIRE"):
                assert re.search(b"^ok ", ask(wire, line))
            wire.close()
            assert time.monotonic() - start < QUICK

    def test_sessions_that_wait_do_not_keep_others_out(self):
        port = self.start("--max-memory", "128M")
        bystander = Bystander(port)
        replies = [fill(self.connect(port)) for _ in range(24)]
        assert True in replies
        self.check_newcomers(port)
        time.sleep(3)  # the subject: the server stays so while time passes
        self.check_newcomers(port)
        assert bystander.close() == {b"ok"}
        assert self.memory("resident") < 128

    def test_many_that_hold_little_do_not_keep_others_out(self):
        port = self.start("--max-memory", "80M")
        bystander = Bystander(port)
        crowd = []
        for _ in range(400):
            crowd.append(self.connect(port))
            for line in (b"load beamfall", b"act FIRE*60"):
                crowd[-1].send(line + b"\n")
        for wire in crowd:
            wire.read(1 << 16)
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end and self.memory("counted") > 76:
            time.sleep(0.1)
        self.check_newcomers(port)
        assert bystander.close() == {b"ok"}

    @pytest.mark.parametrize("limit, images", ((64, 40), (512, 150)))
    def test_code_and_resets_of_all_images_together_stay_within_a_sixteenth(self, limit, images):
        with tempfile.TemporaryDirectory() as folder:
            write_images(folder, images)
            port = self.start("--max-memory", f"{limit}M", "--roms", folder)
            resident, counted = self.memory("resident"), self.memory("counted")
            for number in range(images):
                wire = self.connect(port)
                for line in (b"load image-%d as=beamfall seed=1" % number, b"act 0*30 1*10 3*60"):
                    assert re.search(b"^ok ", ask(wire, line))
            sessions = self.memory("counted") - counted
            caches = min(limit / 16, 24)
            assert self.memory("resident") - resident < caches + 1.1 * sessions + 1

    def test_who_does_not_read_is_ended_first(self):
        port = self.start("--max-memory", "96M")
        bystander, waiting = Bystander(port), self.connect(port)
        assert re.search(b"^ok ", ask(waiting, b"load beamfall"))
        for _ in range(30):
            wire = self.connect(port)
            wire.connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 14)
            for line in (LONG, b"observe rgb:hex"):
                ask(wire, line)
            wire.send(b"open 8\n" + b"step NOOP\n" * 50)
        time.sleep(3)  # the subject: so long, nobody reads
        self.check_newcomers(port)
        assert bystander.close() == {b"ok"}
        assert re.search(b"^ok ", ask(waiting, b"act FIRE"))

    def test_the_owner_who_holds_most_makes_room(self):
        port = self.start("--max-memory", "80M")
        waiting = self.connect(port)
        assert re.search(b"^ok ", ask(waiting, b"load beamfall"))
        assert re.search(b"^ok ", ask(waiting, b"open 8"))
        many = []
        for _ in range(300):
            many.append(self.connect(port, "127.0.0.2"))
            many[-1].send(b"load beamfall\nact FIRE*60\nsave a\nsave b\n")
        for wire in many:
            wire.read(1 << 16)  # their work is done
        self.check_newcomers(port)
        time.sleep(4)  # the subject: the sessions stay idle
        self.check_newcomers(port)
        assert re.search(b"^ok ", ask(waiting, b"step NOOP"))

    def test_clients_without_room_wait_together_and_are_refused(self):
        port = self.start("--max-memory", "24M")
        crowd = []
        while len(crowd) < 800:  # one owner, whose sessions hold equally little: none of them is ended
            crowd.append(self.connect(port))
            crowd[-1].send(b"load beamfall\nact FIRE*60\n")
            if crowd[-1].read(1 << 16).startswith(b"error busy "):
                break
        began = time.monotonic()
        late = [self.connect(port) for _ in range(100)]
        for wire in late:
            assert re.search(b"^error busy .*hold all the memory", wire.read(1 << 16))
        assert time.monotonic() - began < 3 * QUICK

    def test_a_long_line_without_memory_is_refused_and_the_session_goes_on(self):
        port = self.start("--max-memory", "64M", "--max-line", "100000000")
        wire = self.connect(port)
        assert re.search(b"^error limit the server has no memory for a line of more than", ask(wire, b"x" * 90_000_000))
        assert re.search(b"^ok ", ask(wire, b"games"))

    @pytest.mark.parametrize("options", ((), ("--max-memory", "0")))
    def test_the_memory_of_ended_sessions_goes_back_to_the_system(self, options):
        port = self.start(*options)
        low = self.memory("resident")
        wires = []
        for _ in range(600):
            wires.append(connect_tcp(port))
            wires[-1].send(b"load beamfall\nact FIRE*60\nsave a\nact LEFT*20\n")
        for wire in wires:
            wire.line()
            wire.line()
        bound = low + (self.memory("resident") - low) / 4
        for wire in wires:
            wire.close()
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end and self.memory("resident") > bound:
            time.sleep(0.1)
        assert self.memory("resident") < bound
