"""Sockets that systemd passes on, and its notifications."""

import os
import signal
import socket
import subprocess
import tempfile

from harness import (
    BINARY,
    GAME,
    PATIENCE,
    ask,
    connect_unix,
    run,
)


class TestSystemd:
    """The convention of systemd, played by the test: sockets from descriptor 3 on, and variables that name
    this process."""

    def start(self, folder, options, names="line:classic"):
        sockets = [socket.socket(socket.AF_UNIX) for _ in range(2)]
        for number, listener in enumerate(sockets):
            listener.bind(os.path.join(folder, f"s{number}"))
            listener.listen()
        fds = [listener.fileno() for listener in sockets]
        script = "".join(f"os.dup2({fd}, {20 + place}); " for place, fd in enumerate(fds))
        script += "".join(f"os.dup2({20 + place}, {3 + place}); " for place in range(2))
        script = (
            f"import os, sys; {script} os.environ['LISTEN_PID'] = str(os.getpid()); os.execv(sys.argv[1], sys.argv[1:])"
        )
        notify = socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM)
        notify.bind(os.path.join(folder, "notify"))
        notify.settimeout(PATIENCE)
        environment = {
            **os.environ,
            "LISTEN_FDS": "2",
            "LISTEN_FDNAMES": names,
            "NOTIFY_SOCKET": os.path.join(folder, "notify"),
        }
        process = subprocess.Popen(
            ["python3", "-c", script, BINARY, "serve", *options], env=environment, pass_fds=fds, stderr=subprocess.PIPE
        )
        for listener in sockets:
            listener.close()
        return process, notify

    def test_its_sockets_are_served_and_it_is_notified(self):
        with tempfile.TemporaryDirectory() as folder:
            process, notify = self.start(
                folder, ["--listen", "systemd:line", "--listen", "classic+systemd:classic", "--rom", GAME]
            )
            assert notify.recv(100) == b"READY=1"
            line, classic = (connect_unix(os.path.join(folder, name)) for name in ("s0", "s1"))
            assert ask(line, b"hello").startswith(b"ok ")
            assert classic.line() == b"160-210\n"
            for wire in (line, classic):
                wire.close()
            process.send_signal(signal.SIGTERM)
            assert notify.recv(100) == b"STOPPING=1"
            assert process.wait(PATIENCE) == 0
            assert os.path.exists(os.path.join(folder, "s0"))  # systemd's, not ours to remove
            process.stderr.close()
            notify.close()

    def test_an_address_without_a_name_is_all_its_sockets(self):
        with tempfile.TemporaryDirectory() as folder:
            process, notify = self.start(folder, ["--listen", "systemd"])
            assert notify.recv(100) == b"READY=1"
            for name in ("s0", "s1"):
                wire = connect_unix(os.path.join(folder, name))
                assert ask(wire, b"hello").startswith(b"ok ")
                wire.close()
            process.terminate()
            assert process.wait(PATIENCE) == 0
            process.stderr.close()
            notify.close()

    def test_a_socket_can_be_selected_once(self):
        for first in ("systemd:classic", "systemd"):
            with tempfile.TemporaryDirectory() as folder:
                process, notify = self.start(folder, ["--listen", first, "--listen", "systemd:classic"])
                errors = process.communicate(timeout=PATIENCE)[1].splitlines()
                assert errors == [b"racebeam: two addresses select the socket 'classic' of systemd; name it once"]
                assert process.returncode == 1
                notify.close()

    def test_what_it_did_not_pass_on_is_an_error(self):
        with tempfile.TemporaryDirectory() as folder:
            process, notify = self.start(folder, ["--listen", "systemd:other"])
            assert b"a socket named 'other'" in process.communicate(timeout=PATIENCE)[1]
            assert process.returncode == 1
            notify.close()
        status, _, errors = run("serve", "--listen", "systemd")
        assert (status, len(errors)) == (1, 1), errors
        assert "systemd did not pass a socket" in errors[0]
