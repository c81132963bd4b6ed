"""AtariEnv(server=...) plays what AtariEnv plays, and a server that goes away is an exception."""

import asyncio
import contextlib
import copy
import gc
import os
import pathlib
import pickle
import socket
import subprocess
import sys
import tempfile
import threading
import time
import unittest.mock
import zlib

import package
import pytest

package.require("gymnasium", "numpy")

import numpy as np
import racebeam
import racebeam.program
import racebeam.wire.addresses
from racebeam.wire import aio

pytestmark = pytest.mark.needs_program

SETTINGS = (
    {},
    {"obs_type": "ram", "frameskip": (2, 6), "max_num_frames_per_episode": 150},
    {"obs_type": "grayscale", "repeat_action_probability": 0.5, "difficulty": 1},
    {"sound_obs": True, "frameskip": 3},
    {"preset": "dqn2015"},
    {"life_loss": "restart", "max_num_frames_per_episode": 600},
    {"full_action_space": "console"},
    {"full_action_space": "console", "left": "keyboard"},
    {"sound_obs": "all", "frameskip": 3},
)


@contextlib.contextmanager
def server(*options):
    """A server that serves a Unix socket, and its process."""
    with tempfile.TemporaryDirectory() as folder:
        ready = pathlib.Path(folder, "ready")
        command = [
            racebeam.program.path(),
            "serve",
            "--listen",
            f"unix:{folder}/s",
            "--listen",
            "tcp://127.0.0.1:0",
            "--ready-file",
            str(ready),
            *options,
        ]
        process = subprocess.Popen(command, stderr=subprocess.DEVNULL)
        try:
            while not ready.exists():
                time.sleep(0.01)
            yield [line for line in ready.read_text().splitlines() if not line.startswith("#")], process
        finally:
            process.kill()
            process.wait()


def parts(observation):
    parts_by_name = observation if isinstance(observation, dict) else {"": observation}
    return [(name, value.dtype, value.shape, value.tobytes()) for name, value in parts_by_name.items()]


def play(env, steps):
    env.action_space.seed(4)
    observation, info = env.reset(seed=9)
    results = [(parts(observation), info)]
    for _ in range(steps):
        observation, *rest = env.step(env.action_space.sample())
        results.append((parts(observation), rest))
        if rest[1] or rest[2]:
            observation, info = env.reset()
            results.append((parts(observation), info))
    return results


class TestEnvironment:
    def test_it_is_the_same_over_the_wire(self, subtests):
        with server() as (addresses, _):
            assert [address.split(":")[0] for address in sorted(addresses)] == ["tcp", "unix"]
            for address in addresses:
                for settings in SETTINGS:
                    with subtests.test(address=address, settings=settings):
                        here, there = (
                            racebeam.AtariEnv("beamfall", server=where, **settings) for where in (None, address)
                        )
                        assert there.observation_space == here.observation_space
                        assert play(there, 300) == play(here, 300)
                        there.close()

    def test_an_image_that_only_the_client_has_is_sent(self, subtests):
        if "pong" not in package.roms():
            pytest.skip("no image of pong was found")
        with server() as (addresses, _):
            for settings in ({}, {"continuous": True}, {"two_player": True}, {"mode": 1, "difficulty": 2}):
                with subtests.test(settings=settings):
                    here, there = (
                        racebeam.AtariEnv("pong", server=where, **settings) for where in (None, addresses[0])
                    )
                    assert play(there, 100) == play(here, 100)

    def test_states_move_between_this_process_and_the_server(self):
        with server() as (addresses, _):
            here, there = (racebeam.AtariEnv("beamfall", server=where) for where in (None, addresses[0]))
            here.reset(seed=1)
            there.reset(seed=2)
            [here.step(1) for _ in range(20)]
            there.restore_state(here.clone_state(include_rng=True))
            assert there.clone_state(include_rng=True) == here.clone_state(include_rng=True)
            copy = pickle.loads(pickle.dumps(there))
            for _ in range(50):
                steps = [env.step(2) for env in (here, there, copy)]
                assert {step[0].tobytes() for step in steps} == {steps[0][0].tobytes()}
                assert [step[1:] for step in steps[1:]] == [steps[0][1:]] * 2

    def test_bad_input_raises_the_same_errors_as_in_this_process(self, subtests):
        with server() as (addresses, _):
            for arguments, error in (
                ({"mode": 7}, RuntimeError),
                ({"difficulty": 9}, RuntimeError),
                ({"rules": "x"}, ValueError),
                ({"rom": b"x" * 600000}, racebeam.InvalidInput),
            ):
                with subtests.test(arguments=arguments), pytest.raises(error):
                    racebeam.AtariEnv("beamfall", server=addresses[0], **arguments)
            with pytest.raises(racebeam.UnknownGame):
                racebeam.AtariEnv("beamfal", server=addresses[0])
            good = (package.SOURCE / "games/homebrew/beamfall.bin").read_bytes()
            for rom in (bytearray(good), memoryview(good)):
                racebeam.AtariEnv("beamfall", server=addresses[0], rom=rom).ale.loadROM(rom)
            env = racebeam.AtariEnv("beamfall", server=addresses[0])
            with pytest.raises(IndexError):
                env.step(18)
            for state in (None, b"", {}, np.zeros(3)):
                with pytest.raises(TypeError, match="it takes an ALEState"):
                    env.restore_state(state)

    def test_the_interface_accepts_and_refuses_what_a_local_one_does(self, subtests):
        wrong = ("x", None, 1.5, -1, 2**40, True, np.int64(0), np.bool_(True), [0])
        names = ("setMode", "setDifficulty", "act", "cloneState", "game_over", "restoreState")
        calls = [(name, (value,)) for value in wrong for name in names]
        calls += [("setRAM", (1, value)) for value in wrong]
        calls += [("setRAM", words) for words in ((1, 255), (1, 256), (128, 0), (True, 1), ("x", 1))]
        calls += [("act", words) for words in ((racebeam.Action.FIRE,), (18,), (1, True), (1, "x"), (1, float("nan")))]
        calls += [("saveScreenPNG", (5,))]
        defaults = [1, 1.0, 1, 2, 18, 0.0]
        calls += [("step", (*defaults[:at], value, *defaults[at + 1 :])) for at in (0, 3, 4) for value in wrong]
        calls += [
            ("step", words) for words in ((1, "x", 1, 2), (1, 1.0, "x", 2), (1, 1.0, 1, 2, 18, "x"), (1, True, 1, 2))
        ]
        shapes = {"getScreen": (210, 160), "getScreenRGB": (210, 160, 3), "getRAM": (128,), "getAudio": (512,)}
        for name, shape in shapes.items():
            count = int(np.prod(shape))
            buffers = [np.zeros(shape, kind) for kind in (np.uint8, np.int8, np.int32, np.float64)]
            buffers += [np.frombuffer(bytes(count), np.uint8).reshape(shape), np.zeros((*shape, 2), np.uint8)[..., 0]]
            buffers += [np.zeros((2, 2), np.uint8)]
            calls += [(name, (buffer,)) for buffer in (*buffers, bytearray(count), bytearray(1), [0], "x", None)]

        def outcome(ale, name, words):
            try:
                value = getattr(ale, name)(*words)
            except Exception as error:
                return type(error)
            checksum = zlib.crc32(bytes(words[0])) if name.startswith("get") else 0
            return "a state" if isinstance(value, racebeam.ALEState) else str(value), checksum

        with server() as (addresses, _):
            here, there = (racebeam.AtariEnv("beamfall", server=where).ale for where in (None, addresses[0]))
            for ale in (here, there):
                ale.setInt("random_seed", 5)
                ale.loadROM(racebeam.find_image("beamfall") if ale is here else None, "beamfall")
            assert [name for name in dir(here) if not hasattr(there, name)] == []
            for name, words in calls:
                with subtests.test(name=name, words=words):
                    assert outcome(there, name, words) == outcome(here, name, words)
            assert there.state_hash() == here.state_hash()
            here.act(1)
            assert there.state_hash() != here.state_hash()
            assert there.isSupportedROM(b"x") == here.isSupportedROM(b"x")
            there.setLoggerMode(racebeam.LoggerMode.Error)

    def test_a_server_that_dies_is_a_ConnectionError(self):
        with server() as (addresses, process):
            env = racebeam.AtariEnv("beamfall", server=addresses[0])
            env.reset(seed=1)
            process.kill()
            process.wait()
            for call in (lambda: env.step(0), env.reset, env.clone_state):
                with pytest.raises(ConnectionError):
                    call()
            env.close()
            with pytest.raises(OSError):
                racebeam.AtariEnv("beamfall", server=addresses[0])


class TestSessions:
    def test_arrays_have_shapes(self):
        with racebeam.launch(arrays=True) as session:
            session.load("beamfall", seed=1, sound=1)
            result = session.look("screen", "rgb", "grey", "ram", "palette", "audio")
            assert {name: value.shape for name, value in result.items()} == {
                "screen": (210, 160),
                "rgb": (210, 160, 3),
                "grey": (210, 160),
                "ram": (128,),
                "palette": (256, 3),
                "audio": (512,),
            }
            assert np.array_equal(result["palette"][result["screen"]], result["rgb"])
            session.observe("grey84x4", "screen:delta")
            assert [session.act(1)[name].shape for name in ("grey84x4", "screen")] == [(4, 84, 84), (210, 160)]

    def test_addresses(self, subtests):
        for address in ("", "tcp:", "tcp://", "tcp://host", "udp://host:1", "unix:", "tcp://host:port", "host:1"):
            with subtests.test(address=address), pytest.raises(ValueError, match="it takes tcp://HOST:PORT"):
                racebeam.connect(address)
        for address, error in (
            ("unix:/nowhere", FileNotFoundError),
            ("pipes:/nowhere", FileNotFoundError),
            ("file:/nowhere", FileNotFoundError),
            ("tcp://127.0.0.1:1", ConnectionError),
            ("tls://127.0.0.1:1", ConnectionError),
            ("tcp://host.invalid:1", socket.gaierror),
        ):
            with subtests.test(address=address), pytest.raises(error):
                racebeam.connect(address)

    def test_Windows_has_fewer_kinds_of_addresses(self, subtests):
        for address in ("unix:/nowhere", "pipes:/nowhere"):
            with (
                subtests.test(address=address),
                unittest.mock.patch.object(racebeam.wire.addresses, "IS_WINDOWS", True),
                pytest.raises(ValueError, match=f"the address is '{address}'; on Windows, it takes tcp://HOST:PORT"),
            ):
                racebeam.connect(address)

    def test_a_token_is_sent(self):
        with tempfile.TemporaryDirectory() as folder:
            tokens = pathlib.Path(folder, "tokens")
            tokens.write_text("0123456789abcdef0123456789abcdef\n")
            tokens.chmod(0o600)
            output = subprocess.run([racebeam.program.path(), "serve", "--help"], capture_output=True, text=True).stdout
            assert "--token-file" in output
            with server("--token-file", str(tokens)) as (addresses, _):
                tcp = next(address for address in addresses if address.startswith("tcp"))
                with pytest.raises(racebeam.Refused) as refused:
                    racebeam.connect(tcp, token="0" * 32)
                assert refused.value.code == "unauthorized"
                with racebeam.connect(tcp, token="0123456789abcdef0123456789abcdef") as session:
                    assert session.load("beamfall")["game"] == "beamfall"
                for make in (racebeam.AtariEnv, racebeam.AtariVectorEnv):
                    make("beamfall", server=tcp, token="0123456789abcdef0123456789abcdef").reset(seed=1)
                    with pytest.raises(racebeam.Refused) as refused:
                        make("beamfall", server=tcp)
                    assert refused.value.code == "unauthorized"

    def test_a_session_is_opened_again_only_when_asked(self):
        with server() as (addresses, _):
            session = racebeam.connect(addresses[0])
            session.load("beamfall")
            session.close_connection()
            with pytest.raises(ConnectionError):
                session.act(1)
            with session.reconnect() as again:
                with pytest.raises(racebeam.Refused) as refused:
                    again.act(1)
                assert refused.value.code == "no-game"
        with racebeam.launch() as session, pytest.raises(ValueError):
            session.reconnect()

    def test_a_server_that_is_silent_is_a_TimeoutError(self):
        with socket.create_server(("127.0.0.1", 0)) as silent, pytest.raises(TimeoutError):
            racebeam.connect(f"tcp://127.0.0.1:{silent.getsockname()[1]}", timeout=0.2)

    @contextlib.contextmanager
    def server_of(self, *replies):
        """The address of a server that sends these replies, one a request, and then closes."""

        def answer():
            connection, _ = listener.accept()
            for reply in replies:
                connection.recv(100)
                connection.sendall(reply)
            connection.close()

        with socket.create_server(("127.0.0.1", 0)) as listener:
            thread = threading.Thread(target=answer)
            thread.start()
            yield f"tcp://127.0.0.1:{listener.getsockname()[1]}"
            thread.join()

    def test_half_a_reply_ends_the_session(self):
        with self.server_of(b"ok server=x protocol=1\n", b"ok reward=") as address:
            session = racebeam.connect(address)
            for _ in range(2):
                with pytest.raises(ConnectionError):
                    session.act(1)

    def test_another_version_of_the_protocol_is_refused(self):
        with self.server_of(b"ok server=x protocol=2\n") as address:
            with pytest.raises(ConnectionError, match="speaks version 2"):
                racebeam.connect(address)

    @staticmethod
    @contextlib.contextmanager
    def server_without_old_words(folder):
        """A server at the address that this yields. In the end, its log must not name an old word."""
        program, address, ready = racebeam.program.path(), f"unix:{folder}/s", folder / "ready"
        command = [program, "serve", "--listen", address, "--ready-file", ready, "--log-level", "warning"]
        with open(folder / "log", "w") as log, subprocess.Popen(command, stderr=log) as process:
            while not ready.exists() and process.poll() is None:
                time.sleep(0.01)
            try:
                yield address
            finally:
                process.terminate()
        assert "old word" not in (folder / "log").read_text()

    def test_saving_a_state_uses_no_old_word(self, tmp_path):
        with self.server_without_old_words(tmp_path) as address:
            racebeam.AtariEnv("beamfall", server=address).clone_state(include_rng=True)
            racebeam.AtariVectorEnv("beamfall", 2, server=address).save(0)

    def test_no_effect_of_a_lost_life_uses_an_old_word(self, tmp_path):
        with self.server_without_old_words(tmp_path) as address:
            for word in ("ignored", "reported", "end", "restart"):
                racebeam.AtariEnv("beamfall", life_loss=word, server=address).reset()
                racebeam.AtariVectorEnv("beamfall", 2, life_loss=word, server=address).reset()

    def test_a_lost_life_truncates_the_interface_as_in_this_process(self):
        with server() as (addresses, _):
            ends = []
            for where in (None, addresses[0]):
                env = racebeam.AtariEnv("beamfall", life_loss="restart", server=where)
                env.reset(seed=3)
                lives = env.ale.lives()
                while not env.ale.game_over():
                    env.ale.act(0)
                assert 0 < env.ale.lives() < lives
                ends.append(
                    (env.ale.game_over(with_truncation=False), env.ale.game_truncated(), env.ale.getFrameNumber())
                )
            assert ends[0] == ends[1]
            assert ends[0][:2] == (False, True)

    def test_bytes_to_write_are_bytes_or_numbers(self, subtests):
        with racebeam.launch() as session:
            session.load("beamfall")
            for data in (b"\1\xff", bytearray(b"\1\xff"), memoryview(b"\1\xff"), [1, 255], np.array([1, 255])):
                with subtests.test(data=data):
                    session.poke(3, b"\0\0")
                    session.poke(3, data)
                    assert session.peek(3, 2) == b"\1\xff"
            for data in (5, "01FF", None, [256], [1.0], np.array([0.5])):
                with subtests.test(data=data), pytest.raises(TypeError, match="data is .*; it takes bytes, or numbers"):
                    session.poke(3, data)

    def test_a_session_cannot_be_copied(self):
        with racebeam.launch() as session:
            for call in (copy.copy, copy.deepcopy, pickle.dumps):
                with pytest.raises(TypeError, match="a session cannot be pickled or copied"):
                    call(session)
            assert session.games()

    def test_a_request_is_one_line(self):
        with racebeam.launch() as session:
            with pytest.raises(ValueError, match="a request is one line"):
                session.load("beamfall\nquit")
            assert session.load("beamfall")["game"] == "beamfall"

    def test_a_session_ends_with_the_last_reference_to_it(self):
        def memory():
            children = pathlib.Path(f"/proc/self/task/{os.getpid()}/children").read_text().split()
            return children, len(os.listdir("/proc/self/fd"))

        gc.collect()
        before = memory()
        for _ in range(3):
            racebeam.launch().load("beamfall")
        gc.collect()
        assert memory() == before

    def test_a_session_may_be_left_to_the_end_of_python(self):
        script = "import racebeam; session = racebeam.launch(); session.load('beamfall')"
        done = subprocess.run([sys.executable, "-X", "dev", "-c", script], capture_output=True, text=True, timeout=60)
        assert (done.returncode, done.stderr) == (0, "")

    def test_a_program_that_refuses_its_arguments_is_a_ConnectionError(self):
        for options in (("--nope",), ("--classic", "--rom", "builtin:beamfall")):
            with pytest.raises(ConnectionError, match=f"did not start to serve: .* serve --stdio .*{options[0]}"):
                racebeam.launch(*options)

    def test_a_server_with_another_address_ends_with_its_session(self, tmp_path):
        with racebeam.launch("--listen", f"unix:{tmp_path}/s") as session:
            racebeam.connect(f"unix:{tmp_path}/s").close_connection()
            assert session.games()
        with pytest.raises(OSError):
            racebeam.connect(f"unix:{tmp_path}/s")

    def test_so_does_one_of_asyncio(self, tmp_path):
        async def play():
            async with await aio.launch("--listen", f"unix:{tmp_path}/s") as session:
                await session.request("games")

        asyncio.run(asyncio.wait_for(play(), 60))
        with pytest.raises(OSError):
            racebeam.connect(f"unix:{tmp_path}/s")

    def test_the_single_file_works_without_the_package(self):
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, "client.py").write_bytes(
                (package.SOURCE / "clients/python/single_file/client.py").read_bytes()
            )
            script = (
                "import client; s = client.launch(); print(s.load('beamfall', seed=1)['seed']); s.close_connection()"
            )
            path = os.path.dirname(racebeam.program.path()) + ":" + os.environ["PATH"]
            done = subprocess.run(
                [sys.executable, "-S", "-c", script],
                cwd=folder,
                capture_output=True,
                text=True,
                env={**os.environ, "PATH": path},
            )
            assert done.stdout == "1\n", done.stderr
