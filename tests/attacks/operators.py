"""Attacks on a running server by what surrounds it: pipes, folders, sockets of systemd, and certificates."""

import contextlib
import os
import pathlib
import signal
import socket
import ssl
import subprocess
import sys
import tempfile
import threading
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from attack import BINARY, LOAD, PATIENCE, Lacking, attack, fault_of_end, fault_of_line
from harness import GAME, Server, ask, connect_tcp, open_pipes

IMAGE = (pathlib.Path(__file__).resolve().parents[2] / "games/homebrew/updraft.bin").read_bytes()


@attack(times=20)
def pipes(chance, times):
    """Two clients on one pair of pipes; then the pipes are removed and made anew, or are something else. The server
    ends, or serves; it never hangs, and removes nothing that is not its own."""
    for _ in range(times):
        with Server("serve", "--classic", "--rom", GAME, "--pipes", "p", "--grace", "0") as server:
            server.wait_for("for a client that opens")
            wires = [open_pipes(server, "p") for _ in range(2)]
            for wire in wires:
                with contextlib.suppress(BrokenPipeError):
                    wire.send(b"1,0,0,1\n" + b"0,18\n" * chance.randrange(1, 20))
            for end in ("p_in", "p_out"):
                if chance.random() < 0.7:
                    os.unlink(server.path(end))
                    chance.choice([os.mkfifo, os.mkdir, lambda path: pathlib.Path(path).write_bytes(b"a file")])(
                        server.path(end)
                    )
            replaced = {end for end in ("p_in", "p_out") if not pathlib.Path(server.path(end)).is_fifo()}
            for wire in chance.sample(wires, 2):
                with contextlib.suppress(BrokenPipeError):
                    wire.send(b"0,18\n" * 5)
                wire.close()
            try:
                status = server.process.wait(5)
            except subprocess.TimeoutExpired:
                status = server.stop()
            yield fault_of_end(status, "\n".join(server.log()))
            gone = [end for end in replaced if not os.path.exists(server.path(end))]
            yield f"the server removed {gone}, which it did not make" if gone else ""


def change_folder(folder, chance):
    """One change of a folder of images."""
    path = folder / chance.choice(["updraft.bin", "other.bin", "x.zip", "deep/updraft.bin", "link.bin"])
    with contextlib.suppress(OSError):
        if chance.random() < 0.3:
            os.replace(path, folder / "moved.bin")
        elif path.is_dir():
            path.rmdir()
        elif path.exists() or path.is_symlink():
            path.unlink()
        else:
            path.parent.mkdir(exist_ok=True)
            chance.choice(
                [
                    lambda: path.write_bytes(IMAGE),
                    lambda: path.write_bytes(IMAGE[: chance.randrange(len(IMAGE))]),
                    lambda: path.mkdir(),
                    lambda: os.mkfifo(path),
                    lambda: path.symlink_to("/dev/zero"),
                    lambda: path.symlink_to(path.name),
                ]
            )()


@attack(times=20)
def folder_of_images(chance, times):
    """The folder of --roms changes while the server starts, and while it runs and a client loads from it."""
    for _ in range(times):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            (folder / "updraft.bin").write_bytes(IMAGE)
            ended = threading.Event()

            def keep_changing(folder=folder, ended=ended):
                while not ended.is_set():
                    change_folder(folder, chance)

            changes = threading.Thread(target=keep_changing)
            changes.start()
            try:
                with Server("serve", "--listen", "tcp://127.0.0.1:0", "--roms", name, "--grace", "0") as server:
                    wire = connect_tcp(server.port())
                    for _ in range(20):
                        for request in (b"games", b"load updraft", LOAD, b"act 0*10"):
                            yield fault_of_line(ask(wire, request))
                        os.kill(server.process.pid, signal.SIGHUP)
                    yield fault_of_line(ask(wire, b"load other"))
                    yield "" if ask(wire, LOAD).startswith(b"ok ") else "a game of the program cannot be loaded"
                    wire.close()
                    yield fault_of_end(server.stop(), "\n".join(server.log()))
            finally:
                ended.set()
                changes.join()


def descriptors():
    """Descriptors that a parent passes on: a file, datagrams, a socket without an address, one that listens, and a
    connection."""
    made = [
        tempfile.TemporaryFile(),
        socket.socket(socket.AF_INET, socket.SOCK_DGRAM),
        socket.socket(socket.AF_UNIX),
        socket.socket(),
    ]
    made[3].bind(("127.0.0.1", 0))
    made[3].listen()
    made += socket.socketpair()
    return made


@attack(times=60)
def sockets_of_systemd(chance, times):
    """Numbers and names of sockets that do not fit, and descriptors that systemd never passes on. The server says what
    is wrong, or serves."""
    numbers = ["0", "1", "2", "3", "-1", "99999999999", "x", "", "3 ", "+1", "1e3"]
    for _ in range(times):
        sockets = descriptors()
        chosen = chance.sample(sockets, chance.randrange(len(sockets) + 1))
        script = "import os, sys\n"
        script += "".join(f"os.dup2({one.fileno()}, {50 + place})\n" for place, one in enumerate(chosen))
        script += "".join(f"os.dup2({50 + place}, {3 + place})\n" for place in range(len(chosen)))
        script += f"os.environ['LISTEN_PID'] = {'str(os.getpid())' if chance.random() < 0.8 else repr('1')}\n"
        script += "os.execv(sys.argv[1], sys.argv[1:])"
        fds = str(len(chosen)) if chance.random() < 0.5 else chance.choice(numbers)
        names = chance.choice([":".join(["line"] * len(chosen)), "", "a:b:c:d:e:f", ":::", "x" * 5000, "line"])
        words = ["serve", "--listen", chance.choice(["systemd", "systemd:line", "classic+systemd:line"]), "--rom", GAME]
        process = subprocess.Popen(
            [sys.executable, "-c", script, BINARY, *words, "--until-idle", "1", "--grace", "0"],
            env=os.environ | {"LISTEN_FDS": fds, "LISTEN_FDNAMES": names},
            pass_fds=[one.fileno() for one in sockets],
            stderr=subprocess.PIPE,
        )
        try:
            _, errors = process.communicate(timeout=PATIENCE)
            yield fault_of_end(process.returncode, errors.decode(errors="replace"))
        except subprocess.TimeoutExpired:
            process.kill()
            process.communicate()
            yield f"the server hangs with LISTEN_FDS={fds}, LISTEN_FDNAMES={names}"
        for one in sockets:
            one.close()


@attack(times=5)
def socket_activation(chance, times):
    """The server as systemd-socket-activate starts it: at the first connection."""
    for _ in range(times):
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            port = free.getsockname()[1]
        command = ["systemd-socket-activate", "-l", f"127.0.0.1:{port}", BINARY, "serve", "--listen", "systemd"]
        try:
            process = subprocess.Popen([*command, "--until-idle", "1"], stderr=subprocess.DEVNULL)
        except FileNotFoundError:
            raise Lacking("systemd-socket-activate is missing") from None
        until = time.monotonic() + PATIENCE
        while True:  # until the port is open
            try:
                wire = connect_tcp(port)
                break
            except ConnectionRefusedError:
                if time.monotonic() > until:
                    raise
                time.sleep(0.01)
        yield fault_of_line(ask(wire, LOAD))
        wire.close()
        yield "" if process.wait(PATIENCE) == 0 else f"the status is {process.returncode}"


def make_certificates(folder, count):
    """The paths of `count` certificates, each with its key."""
    made = []
    for number in range(count):
        pair = folder / f"certificate-{number}.pem", folder / f"key-{number}.pem"
        subprocess.run(
            ["openssl", "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:P-256", "-nodes"]
            + ["-subj", f"/CN=server-{number}", "-days", "1", "-out", pair[0], "-keyout", pair[1]],
            check=True,
            capture_output=True,
        )
        made.append(pair)
    return made


def handshake(port):
    """Returns a TLS connection, and the certificate of the server."""
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
    connection = context.wrap_socket(socket.create_connection(("127.0.0.1", port), timeout=PATIENCE))
    return connection, connection.getpeercert(binary_form=True)


@attack(times=100)
def certificates_swapped(chance, times):
    """Certificate and key are replaced one after the other, cut or emptied, and the server is told to read them again.
    Sessions that run go on, and a new one gets a whole pair."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        pairs = make_certificates(folder, 3)
        good = {ssl.PEM_cert_to_DER_cert(certificate.read_text()) for certificate, _ in pairs}
        used = folder / "certificate.pem", folder / "key.pem"
        for path, source in zip(used, pairs[0]):
            path.write_bytes(source.read_bytes())
        command = ["--listen", "tls://127.0.0.1:0", "--tls-cert", str(used[0]), "--tls-key", str(used[1])]
        with Server("serve", *command, "--ready-file", "ready", "--grace", "0") as server:
            port = int(server.addresses("ready")[0].rsplit(":", 1)[1])
            old, _ = handshake(port)
            for _ in range(times):
                certificate, key = (chance.choice(pairs) for _ in range(2))
                for path, source in zip(used, (certificate[0], key[1])):
                    text = source.read_bytes()
                    path.write_bytes(text[: chance.randrange(len(text))] if chance.random() < 0.2 else text)
                    os.kill(server.process.pid, signal.SIGHUP)
                    time.sleep(chance.choice([0, 0.01]))
                new, found = handshake(port)
                yield "" if found in good else "a connection has another certificate"
                for connection in (old, new):
                    connection.sendall(b"hello\n")
                    yield "" if connection.recv(1 << 16).startswith(b"ok ") else "a session has ended"
                new.close()
            old.close()
            yield fault_of_end(server.stop(), "\n".join(server.log()))
