"""A server of the tests of WebSockets and the page."""

import os
import socket
import sys
import urllib.error
import urllib.request

import pytest

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
from harness import PATIENCE, Server
from web_socket import Refused, WebSocket


def port_of(server, scheme="ws"):
    return int(server.wait_for(scheme + r"://127\.0\.0\.1:(\d+)$").group(1))


@pytest.mark.usefixtures("self_cleanup")
class Case:
    """A server, and connections to it, which are closed at the end of the test."""

    def start(self, *options, listen="ws://127.0.0.1:0"):
        self.server = Server("serve", "--listen", listen, "--grace", "0", *options)
        self.cleanup(self.server.__exit__)
        return self.server

    def connect(self, scheme="ws", **fields):
        wire = WebSocket(port_of(self.server, scheme), **fields)
        self.cleanup(wire.close)
        return wire

    def raw(self):
        connection = socket.create_connection(("127.0.0.1", port_of(self.server)), timeout=PATIENCE)
        self.cleanup(connection.close)
        return connection

    def refusal(self, scheme="ws", **fields):
        with pytest.raises(Refused) as found:
            self.connect(scheme, **fields)
        return found.value

    def get(self, path, scheme="ws", **fields):
        request = urllib.request.Request(f"http://127.0.0.1:{port_of(self.server, scheme)}{path}", headers=fields)
        try:
            with urllib.request.urlopen(request, timeout=PATIENCE) as response:
                return response.status, response.headers, response.read()
        except urllib.error.HTTPError as error:
            with error:
                return error.code, error.headers, error.read()
