"""Addresses that other machines can reach: what the server refuses on them without tokens and TLS."""

import pytest
from access_case import TOKEN, Folder
from harness import GAME, Server, ask, connect_tcp, run


class TestAddresses(Folder):
    @pytest.mark.parametrize("address", ("tcp://0.0.0.0:0", "tcp://[::]:0"))
    def test_nothing_is_served_without_tokens(self, address):
        status, _, errors = run("serve", "--listen", address)
        assert (status, len(errors)) == (1, 1), errors
        assert "--token-file" in errors[0]

    def test_the_classic_protocol_is_not_served(self):
        tokens = self.write("tokens", TOKEN)
        status, _, errors = run("serve", "--listen", "classic+tcp://0.0.0.0:0", "--rom", GAME, "--token-file", tokens)
        assert (status, len(errors)) == (1, 1), errors
        assert "classic protocol has no tokens" in errors[0]

    def test_a_warning_names_the_risk_of_plain_TCP(self):
        with Server("serve", "--listen", "tcp://0.0.0.0:0", "--token-file", self.write("tokens", TOKEN)) as server:
            server.wait_for(
                "warning: tcp://0.0.0.0:[0-9]+ can be reached from other machines, without TLS: tokens can be read"
            )
            port = int(server.wait_for(r"listening on tcp://0\.0\.0\.0:(\d+)").group(1))
            wire = connect_tcp(port)
            assert ask(wire, b"games").startswith(b"error unauthorized ")
            wire.close()
