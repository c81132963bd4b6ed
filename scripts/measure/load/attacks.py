"""The attacks of scripts/load --hostile: what one session does to a server. ATTACKS has them by name.

HOARDERS are the sessions of the attack on the memory: they take as much as they can get, and keep it. Idle hoarders
fill machines and states, and then wait. Stopped readers ask for long replies, and do not read them. Slow readers take a
few bytes of them at a time. All come back as soon as the server has ended their session.
"""

import base64
import collections
import pathlib
import random
import re
import select
import shutil
import socket
import threading
import time

TOKEN = b"the-token-of-the-hostile-load"

LONG = b"load beamfall as=tetris sticky=0 max_episode_frames=0"  # beamfall, with rules that never end an episode
SKIPPING = LONG + b" frame_skip=1000"


def evil_image():
    """Writes to what the translator has decoded: INC $1B 1,900 times, and a jump to the first."""
    program = bytes([0xE6, 0x1B]) * 1900 + bytes([0x4C, 0x00, 0xF0])
    return program.ljust(4090, b"\0") + bytes([0x00, 0xF0]) * 3


def load_inline(image):
    return b"load inline max_episode_frames=0 image=" + base64.b64encode(image)


class Session:
    """A client's connection. Timeouts are part of the attacks: they end a wait, but not the session."""

    replies = collections.Counter()  # of all sessions

    def __init__(self, port, folder):
        self.folder = folder
        self.socket = socket.create_connection(("127.0.0.1", port), timeout=5)
        self.socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)

    def admit(self):
        self.ask(b"hello token=" + TOKEN)

    def send(self, *lines):
        self.send_bytes(b"".join(line + b"\n" for line in lines))

    def send_bytes(self, data):
        try:
            self.socket.sendall(data)
        except TimeoutError:
            self.replies["(not read by the server)"] += 1

    def read(self, seconds):
        """Returns what is received within `seconds`, or None after the server has closed its end."""
        self.socket.settimeout(seconds)
        try:
            data = self.socket.recv(1 << 18)
        except TimeoutError:
            return b""
        for kind in re.findall(rb"(?:^|\n)(ok|error [a-z-]+)\b", data):
            self.replies[kind.decode()] += 1
        return data or None

    def ask(self, *lines):
        """Waits for the replies, at most 5 seconds for each part of them."""
        self.send(*lines)
        ends = 0
        while ends < len(lines):
            data = self.read(5)
            if not data:
                return
            ends += data.count(b"\n")

    def read_on(self, seconds):
        end = time.monotonic() + seconds
        while time.monotonic() < end and self.read(max(end - time.monotonic(), 0.01)) is not None:
            continue


ATTACKS = {}


def attack(function):
    ATTACKS[function.__name__.replace("_", " ")] = function
    return function


@attack
def long_modes(session):
    session.send(*[b"load beamfall as=adventure mode=1 frame_skip=1000 max_episode_frames=0"] * 20)
    session.read_on(5)


@attack
def no_ops(session):
    session.ask(SKIPPING + b" noop_max=1000")
    session.send(*[b"reset", b"open 256"] * 5)
    session.read_on(5)


@attack
def steps(session):
    session.ask(SKIPPING, b"open 256")
    session.send(*[b"step NOOP", b"restart"] * 20)
    session.read_on(5)


@attack
def leaving(session):
    session.ask(LONG)
    session.send(b"act 0*2000000")
    time.sleep(0.2)


@attack
def half_closing(session):
    session.ask(LONG)
    session.send(b"act 0*200000")
    session.socket.shutdown(socket.SHUT_WR)
    session.read_on(5)


@attack
def searching(session):
    session.ask(LONG, b"save root")
    session.send(*[b"branch root" + b" UP*50,FIRE*20" * 18] * 100)
    session.read_on(5)


def record(session, kind):
    name = f"{kind}-{threading.get_ident()}"
    session.ask(LONG, f"record {kind} {name}".encode())
    session.send(b"act NOOP*50", *[b"act RIGHT*10 LEFT*10"] * 20, b"record stop")
    session.read_on(3)
    for path in pathlib.Path(session.folder).glob(name + "*"):
        if path.is_dir():
            shutil.rmtree(path, ignore_errors=True)
        else:
            path.unlink(missing_ok=True)


@attack
def recording_png(session):
    record(session, "png")


@attack
def recording_gif(session):
    record(session, "gif")


@attack
def recording_y4m(session):
    record(session, "y4m")


@attack
def evil_images(session):
    session.ask(load_inline(evil_image()))
    session.send(*[b"act NOOP*1000"] * 5)
    session.read_on(5)


@attack
def random_images(session):
    for _ in range(8):
        session.ask(load_inline(random.randbytes(4096)), b"act NOOP*60 UP*60", b"look screen:zlib")


@attack
def not_reading(session):
    session.ask(LONG, b"observe rgb:hex")
    session.send(b"open 256", *[b"step NOOP"] * 10)
    time.sleep(4)


@attack
def states(session):
    session.ask(LONG, b"observe grey84x84x16:hex")
    session.send(*[b"save s%d" % number for number in range(256)], b"act NOOP")
    session.read_on(4)


@attack
def many_words(session):
    session.ask(LONG, b"save a")
    session.send(b"act" + b" 0" * 500_000, b"drop" + b" a" * 500_000, b"look" + b" ram" * 250_000)
    session.read_on(5)


@attack
def long_branches(session):
    session.ask(LONG, b"save a")
    session.send(b"branch a" + b" 0" * 400_000, b"branch a 0" + b",0" * 400_000, b"branch a 0*1999999")
    session.read_on(5)


@attack
def endless_lines(session):
    for _ in range(8):
        session.send_bytes(b"a" * (1 << 20))
    session.read_on(1)


@attack
def half_lines(session):
    session.ask(LONG)
    session.send_bytes(b"act NO")
    time.sleep(1)
    session.socket.shutdown(socket.SHUT_WR)
    session.read_on(1)


@attack
def wrong_tokens(session):
    session.send(*[b"hello token=0123456789abcdef"] * 3)
    session.read_on(2)


@attack
def connecting(session):
    time.sleep(0.02)


STRANGERS = {wrong_tokens, connecting}  # attacks without the token


COUNTS = {}


def hoarder(count):
    def register(function):
        COUNTS[function] = count
        return function

    return register


def wait_for_end(session):
    """Until the server closes, which a client that does not read sees as an error."""
    watch = select.poll()
    watch.register(session.socket, select.POLLRDHUP)
    watch.poll(60_000)


@hoarder(48)
def idle_hoarder(session):
    session.ask(LONG, b"observe grey84x84x4:hex", b"open 64", b"step NOOP")
    session.send(*[b"save s%d" % number for number in range(256)])
    session.read_on(60)


def ask_much(session):
    session.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 14)
    session.ask(LONG, b"observe rgb:hex")
    session.send(b"open 16", *[b"step NOOP"] * 50)


@hoarder(48)
def stopped_reader(session):
    ask_much(session)
    wait_for_end(session)


@hoarder(60)
def slow_reader(session):
    ask_much(session)
    while session.socket.recv(1 << 10):
        time.sleep(0.1)


HOARDERS = [function for function, count in COUNTS.items() for _ in range(count)]
