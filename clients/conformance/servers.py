"""The servers that a client talks to in a run of the conformance conversation."""

import base64
import contextlib
import os
import pathlib
import re
import subprocess
import tempfile
import time

import faulty_server

ROOT = pathlib.Path(__file__).resolve().parents[2]
TOKEN = "0123456789abcdef"
PATIENCE = 30  # seconds until a server that is not ready counts as broken


def certificate(folder):
    """A certificate for only 127.0.0.1, and its key."""
    paths = folder / "certificate.pem", folder / "key.pem"
    subprocess.run(
        [
            "openssl",
            "req",
            "-x509",
            "-newkey",
            "ec",
            "-pkeyopt",
            "ec_paramgen_curve:prime256v1",
            "-nodes",
            "-days",
            "2",
            "-subj",
            "/CN=127.0.0.1",
            "-addext",
            "subjectAltName=IP:127.0.0.1",
            "-out",
            paths[0],
            "-keyout",
            paths[1],
        ],
        check=True,
        capture_output=True,
    )
    return paths


def damaged_announcements(announced, folder):
    """Announce files with a fault, and files of other kinds, as variables of the steps."""
    text = announced.read_text()
    texts = {
        "STALE": re.sub(r'"tcp://[^"]*"', f'"{faulty_server.closed_address()}"', text),
        "HALF_WRITTEN": text[: len(text) // 2],
        "LATER_VERSION": text.replace('"racebeam_announce": 1,', '"racebeam_announce": 2,'),
        "NO_ADDRESS": re.sub(r'"tcp://[^"]*"', '"other://x"', text),
        "EMPTY": "",
        "NOTES": "dear diary\n",
        "GARBAGE": "{\x00\xff\x80\n\x1b[31m\n",
    }
    for name, damaged in texts.items():
        (folder / name).write_text(damaged, encoding="latin1")
    (folder / "FOLDER").mkdir()
    os.mkfifo(folder / "FIFO")
    return {name: f"file:{folder / name}" for name in (*texts, "FOLDER", "FIFO")}


class Servers:
    """Starts processes of `racebeam serve` in a folder, and ends them."""

    def __init__(self, racebeam, folder):
        self.racebeam, self.folder = racebeam, folder
        self.processes = []

    def start(self, name, *options):
        """Returns the addresses of the new server, and the file that lists them."""
        ready = self.folder / f"{name}.ready"
        self.processes.append(
            subprocess.Popen(
                [self.racebeam, "serve", "--ready-file", ready, "--log-level", "error", "--grace", "0", *options],
                cwd=self.folder,
            )
        )
        until = time.monotonic() + PATIENCE
        while not ready.exists():
            if self.processes[-1].poll() is not None or time.monotonic() > until:
                raise RuntimeError(f"the server '{name}' did not start")
            time.sleep(0.005)
        return [line for line in ready.read_text().splitlines() if not line.startswith("#")], ready

    def stop(self):
        for process in self.processes:
            process.kill()
            process.wait()


@contextlib.contextmanager
def run_servers(racebeam, roms=None):
    """Starts all servers, and stops them at the end. Yields the variables of the steps: addresses, and other values."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        servers = Servers(racebeam, folder)
        (folder / "tokens").write_text(TOKEN + "\n")
        chain, key = certificate(folder)
        tcp = ("--listen", "tcp://127.0.0.1:0")
        guarded = ("--token-file", "tokens")
        try:
            (main_tcp, main_unix), ready = servers.start(
                "main",
                *tcp,
                "--listen",
                f"unix:{folder}/socket",
                "--record-dir",
                ".",
                "--max-line",
                "100000",
                *(["--roms", roms] if roms else []),
            )
            (tls,), _ = servers.start(
                "tls", "--listen", "tls://127.0.0.1:0", *guarded, "--tls-cert", chain, "--tls-key", key
            )
            announced = folder / "announced"
            servers.start("announced", *tcp, "--announce", announced)
            for pipes in ("pipes", "more_pipes"):  # each serves one client
                servers.start(pipes, "--pipes", folder / pipes)
            yield {
                **faulty_server.start(),
                "TCP": main_tcp,
                "UNIX": main_unix,
                "READY": f"file:{ready}",
                **damaged_announcements(announced, folder),
                "ANNOUNCED": f"file:{announced}",
                "AWAITED": f"file:{announced}?wait=30",
                "GUARDED": servers.start("guarded", *tcp, *guarded, "--idle", "2")[0][0],
                "SMALL": servers.start("small", *tcp, "--max-sessions", "1")[0][0],
                "TLS": tls,
                "MISNAMED": tls.replace("127.0.0.1", "localhost"),
                "PIPES": f"pipes:{folder}/pipes",
                "MORE_PIPES": f"pipes:{folder}/more_pipes",
                "TOKEN": TOKEN,
                "AUTHORITY": str(chain),
                "IMAGE": base64.b64encode((ROOT / "games/homebrew/updraft.bin").read_bytes()).decode(),
                "LONG": "A" * 110000,
                "PICTURE": f"{folder}/picture.png",
                "RACEBEAM_BINARY": str(racebeam),
                **{name: os.environ[name] for name in ("PATH", "HOME", "JAVA_HOME") if name in os.environ},
            }
        finally:
            servers.stop()
