"""Servers that misbehave, for the steps of faults.txt. They speak as much of the protocol as a client needs to
connect."""

import socket
import socketserver
import threading
import time

HELLO = b"ok server=faulty/1 protocol=1\n"
PATIENCE = 30  # seconds after which a fault that lasts ends, should the client not close before


class Connection(socketserver.StreamRequestHandler):
    """Answers `fault NAME ...` by the method of that name."""

    disable_nagle_algorithm = True

    def handle(self):
        self.server.connections.add(self)
        try:
            while line := self.rfile.readline():
                if not self.answer(line.decode().split()):
                    break
            self.connection.shutdown(socket.SHUT_WR)
            self.rfile.read()  # until the client closes: what it has not read is not lost
        except OSError:
            pass
        finally:
            self.server.connections.discard(self)

    def say(self, data):
        self.wfile.write(data)
        return True

    def answer(self, words):
        if words[0] == "hello":
            return self.server.greet(self)
        if words[0] == "observe":
            self.field = words[1].partition(":")[0]
            return self.say(f"ok fields={self.field}\n".encode())
        return getattr(self, words[1].replace("-", "_"))(*words[2:])

    # The faults: whether the conversation goes on

    def ok(self):
        return self.say(b"ok reward=1\n")

    def error(self, code):
        return self.say(f"error {code} a sentence about it\n".encode())

    def damaged(self, text):
        return self.say(f"ok {self.field}={text}\n".encode())

    def bytes(self, size, following):
        return self.say(f"ok {self.field}={size} raw={following}\n\n\n".encode())

    def half_bytes(self):
        self.bytes(128, 128)
        return False

    def silent_bytes(self):
        self.bytes(128, 128)
        return self.silent()

    def die(self):
        return False

    def half_line(self):
        self.say(b"ok rewa")
        return False

    def garbage(self):
        return self.say(b"220 mail.example.org ESMTP\n")

    def binary(self):
        return self.say(bytes(range(128, 256)) + b"\n")

    def endless(self):
        return self.lasts(b"0" * 65536, 0)

    def drip(self):
        return self.lasts(b"0", 0.1)

    def silent(self):
        return self.lasts(b"", 0.1)

    def lasts(self, data, pause):
        until = time.monotonic() + PATIENCE
        self.connection.setblocking(True)
        while time.monotonic() < until:
            self.wfile.write(data)
            if not data and self.closed():
                break
            time.sleep(pause)
        return False

    def closed(self):
        """Whether the client has closed."""
        self.connection.setblocking(False)
        try:
            return self.connection.recv(1) == b""
        except BlockingIOError:
            return False
        finally:
            self.connection.setblocking(True)

    def connections(self):
        """How many connections are open, this one counted: more than one if a client leaks them."""
        until = time.monotonic() + PATIENCE
        while (count := len(self.server.connections)) > 1 and time.monotonic() < until:
            time.sleep(0.01)
        return self.say(f"ok open={count}\n".encode())


GREETINGS = {
    "FAULTY": lambda wire: wire.say(HELLO),
    "NEWER": lambda wire: wire.say(HELLO.replace(b"protocol=1", b"protocol=2")),
    "STRANGER": lambda wire: wire.say(b"HTTP/1.1 400 Bad Request\n") and False,
    "FULL": lambda wire: wire.say(b"error busy the server is full\n") and False,
}


class Server(socketserver.ThreadingTCPServer):
    daemon_threads = True
    allow_reuse_address = True
    request_queue_size = 1024

    def __init__(self, greet):
        super().__init__(("127.0.0.1", 0), Connection)
        self.greet, self.connections = greet, set()
        threading.Thread(target=self.serve_forever, daemon=True).start()

    def handle_error(self, *_):
        """Clients end as they like."""

    def address(self):
        return f"tcp://127.0.0.1:{self.server_address[1]}"


TAKEN = []  # sockets that are bound but do not listen: no other program gets their ports


def closed_address():
    """An address where nothing listens, as long as this process runs."""
    TAKEN.append(socket.socket())
    TAKEN[-1].bind(("127.0.0.1", 0))
    return f"tcp://127.0.0.1:{TAKEN[-1].getsockname()[1]}"


def start():
    """The addresses by name: those of GREETINGS, and CLOSED, where nothing listens."""
    return {name: Server(greet).address() for name, greet in GREETINGS.items()} | {"CLOSED": closed_address()}


if __name__ == "__main__":  # for a client that is tried by hand
    print(*(f"{name}={address}" for name, address in start().items()), sep="\n", flush=True)
    threading.Event().wait()
