"""A client of a WebSocket (RFC 6455), for tests: it can also send what no client should."""

import base64
import hashlib
import os
import socket
import struct

from harness import PATIENCE

TEXT, BINARY, CLOSE, PING, PONG = 1, 2, 8, 9, 10
GUID = b"258EAFA5-E914-47DA-95CA-C5AB0DC85B11"


def request(host, path="/session", **fields):
    """The request that opens a WebSocket. `fields` replace or add fields; None removes one."""
    defaults = {
        "Host": host,
        "Upgrade": "websocket",
        "Connection": "Upgrade",
        "Sec-WebSocket-Version": "13",
        "Sec-WebSocket-Key": base64.b64encode(os.urandom(16)).decode(),
    }
    lines = [f"{name}: {value}\r\n" for name, value in (defaults | fields).items() if value is not None]
    return f"GET {path} HTTP/1.1\r\n{''.join(lines)}\r\n".encode()


def frame(opcode, payload, final=True, mask=b"\x12\x34\x56\x78", length=None):
    """A frame. `mask`: empty for none. `length`: what the frame claims to have."""
    size = len(payload) if length is None else length
    marked = 0x80 if mask else 0
    if size < 126:
        head = struct.pack("!BB", opcode | 0x80 * final, marked | size)
    elif size < 1 << 16:
        head = struct.pack("!BBH", opcode | 0x80 * final, marked | 126, size)
    else:
        head = struct.pack("!BBQ", opcode | 0x80 * final, marked | 127, size)
    if mask:
        key = (mask * (len(payload) // 4 + 1))[: len(payload)]
        payload = (int.from_bytes(payload, "big") ^ int.from_bytes(key, "big")).to_bytes(len(payload), "big")
    return head + mask + payload


class Refused(Exception):
    """The server has answered with another status than 101."""

    def __init__(self, status, text):
        super().__init__(status, text)
        self.status, self.text = status, text


class WebSocket:
    """A session over ws://, or over wss:// with a TLS context."""

    def __init__(self, port, tls=None, **fields):
        connection = socket.create_connection(("127.0.0.1", port), timeout=PATIENCE)
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.connection = tls.wrap_socket(connection, server_hostname="127.0.0.1") if tls else connection
        self.reader = self.connection.makefile("rb")
        opening = request(f"127.0.0.1:{port}", **fields)
        self.write(opening)
        status, found, text = self.response()
        if status != 101:
            self.close()
            raise Refused(status, text)
        key = next(line.split(b": ")[1] for line in opening.split(b"\r\n") if line.startswith(b"Sec-WebSocket-Key"))
        assert found["sec-websocket-accept"] == base64.b64encode(hashlib.sha1(key + GUID).digest()).decode()

    def write(self, data):
        self.connection.sendall(data)

    def response(self):
        """The status, fields and text of the server's answer."""
        status, fields = int(self.reader.readline().split()[1]), {}
        while line := self.reader.readline().decode().strip():
            name, _, value = line.partition(": ")
            fields[name.lower()] = value
        return status, fields, self.reader.read(int(fields.get("content-length", 0))).decode()

    def send(self, text, opcode=TEXT):
        self.write(frame(opcode, text))

    def frame(self):
        """The next frame: whether it is final, its opcode and its payload. None at the end."""
        head = self.reader.read(2)
        if len(head) < 2:
            return None
        size = head[1]  # a server does not mask
        if size >= 126:
            size = int.from_bytes(self.reader.read(2 if size == 126 else 8), "big")
        return bool(head[0] & 0x80), head[0] & 0x0F, self.reader.read(size)

    def message(self):
        """The next message: its opcode and its payload. None at the end."""
        kind, pieces, final = None, [], False
        while not final:
            found = self.frame()
            if found is None:
                return None
            final, opcode, payload = found
            kind = opcode or kind
            pieces.append(payload)
        return kind, b"".join(pieces)

    def line(self):
        opcode, payload = self.message()
        assert opcode == TEXT, (opcode, payload)
        return payload

    def ask(self, text):
        self.send(text)
        return self.line()

    def end(self):
        """The last line, if there is one before the close, and the code of the close; None without one."""
        line = None
        while (found := self.message()) is not None:
            if found[0] == CLOSE:
                return line, int.from_bytes(found[1][:2], "big") if found[1] else None
            line = found[1]
        return line, None

    def close(self):
        self.reader.close()
        self.connection.close()
