"""The memory attack of scripts/load --hostile: sessions that take as much memory as they can get, and keep it.

Idle hoarders fill machines and states, and then wait. Stopped readers ask for long replies, and do not read them. Slow
readers take a few bytes of them at a time. All come back as soon as the server has ended their session.
"""

import select
import socket
import time

from attacks import LONG

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


ALL = [function for function, count in COUNTS.items() for _ in range(count)]
