"""Sessions for asyncio answer what sessions answer, in order, and end with an error that says why."""

import asyncio
import gc
import os
import pathlib
import re
import unittest
import unittest.mock

import package
import pytest

package.require("numpy")

import racebeam
from racebeam.wire import aio

pytestmark = pytest.mark.needs_program

LOAD = ("load", "beamfall")
SETTINGS = {"seed": 7, "frame_skip": 4}
FIELDS = ("reward", "ends", "screen:delta", "grey84x4:raw", "ram:raw")


def plain(values):
    return [
        {key: value.tolist() if hasattr(value, "tolist") else value for key, value in group.items()} for group in values
    ]


def children():
    return pathlib.Path(f"/proc/self/task/{os.getpid()}/children").read_text().split()


class TestSessions(unittest.IsolatedAsyncioTestCase):
    async def asyncSetUp(self):
        asyncio.get_running_loop().set_debug(False)  # it tells of every call that takes long
        self.session = await aio.launch(arrays=True)
        await self.session.request(*LOAD, **SETTINGS)

    async def asyncTearDown(self):
        await self.session.close()

    async def test_requests_that_are_made_together_are_answered_in_order(self):
        await self.session.request("observe", *FIELDS)
        answers = await asyncio.gather(*(self.session.request("act", action) for action in (1, 3, 4, 0) * 5))
        with racebeam.launch(arrays=True) as other:
            other.request(*LOAD, **SETTINGS)
            other.request("observe", *FIELDS)
            expected = [other.request("act", action) for action in (1, 3, 4, 0) * 5]
        assert [plain(answer) for answer in answers] == [plain(answer) for answer in expected]

    async def test_a_refusal_fails_only_its_own_request(self):
        good, bad, after = await asyncio.gather(
            *(self.session.request("act", action) for action in (1, 99, 1)), return_exceptions=True
        )
        assert (bad.code, set(good[0])) == ("bad-action", set(after[0]))

    async def test_help_is_a_text(self):
        with racebeam.launch() as other:
            for words in ((), ("act",)):
                assert await self.session.help(*words) == other.help(*words)
            with pytest.raises(racebeam.Refused, match="unknown word 'bogus'"):
                other.help("bogus")
        bad, after = await asyncio.gather(
            self.session.help("bogus"), self.session.request("act", 1), return_exceptions=True
        )
        assert bad.code == "bad-arguments"
        assert "reward" in after[0]

    async def test_a_request_that_is_cancelled_leaves_the_others(self):
        cancelled, waiting = (asyncio.create_task(self.session.request("act", action)) for action in ("0*3000", "1"))
        await asyncio.sleep(0)
        cancelled.cancel()
        assert "reward" in (await waiting)[0]
        assert cancelled.cancelled()

    async def test_a_request_that_is_cut_off_ends_the_session(self):
        with unittest.mock.patch.object(asyncio, "get_running_loop", side_effect=KeyboardInterrupt):  # after it is sent
            with pytest.raises(KeyboardInterrupt):
                self.session.request("look", "ram").send(None)
        for _ in range(2):
            with pytest.raises(ConnectionError, match="was interrupted between a request and the end of its reply"):
                await self.session.request("act", 1)

    async def test_it_ends_with_the_last_reference_to_it(self):
        before = children(), len(os.listdir("/proc/self/fd"))
        for _ in range(3):
            session = await aio.launch()
            await session.request(*LOAD)
            del session
        gc.collect()
        until = asyncio.get_running_loop().time() + 60
        while (
            now := (children(), len(os.listdir("/proc/self/fd")))
        ) != before and asyncio.get_running_loop().time() < until:
            await asyncio.sleep(0.01)
        assert now == before

    async def test_it_ends(self):
        waiting = asyncio.create_task(self.session.request("act", "0*10000"))
        await asyncio.sleep(0)
        await self.session.close()
        await self.session.close()
        for request in (waiting, self.session.request("act", 1)):
            with pytest.raises(ConnectionError):
                await request


class TestEnds(unittest.IsolatedAsyncioTestCase):
    async def check(self, reply, *expected, **settings):
        """A server that says this after the greeting, and closes."""

        async def answer(reader, writer):
            await reader.readline()
            writer.write(b"ok protocol=1\n")
            await reader.readline()
            writer.write(reply)
            await writer.drain()
            writer.close()

        async with await asyncio.start_server(answer, "127.0.0.1", 0) as server:
            port = server.sockets[0].getsockname()[1]
            async with await aio.connect(f"tcp://127.0.0.1:{port}", **settings) as session:
                with pytest.raises(expected[0], match=expected[1]):
                    await session.request("look", "ram:raw")

    async def test_a_server_that_goes_is_a_ConnectionError(self):
        for greeting in (
            b"",
            b"ok ram=12",
            b"ok ram=4 raw=4\nab",
            b"no\n",
            b"ok ram=9 raw=3\nabc",
            b"ok ram=x raw=3\nabc",
            b"ok ram=1 raw=3\nabc",
            b"ok ram=1 raw=99999999999\n",
        ):
            with self.subTest(greeting=greeting):
                await self.check(greeting, ConnectionError, "has ended")

    async def test_a_line_that_is_too_long_raises_a_ConnectionError(self):
        await self.check(b"ok " + b"x" * 5000, ConnectionError, "has ended", longest_reply=1000)

    async def silent(self, reader, writer):
        """Greets, answers one request late, and no more."""
        await reader.readline()
        writer.write(b"ok protocol=1\n")
        await reader.readline()
        await asyncio.sleep(0.3)
        writer.write(b"ok reward=1\n")
        await reader.read()
        writer.close()

    async def test_a_silent_server_is_a_TimeoutError(self):
        async with await asyncio.start_server(self.silent, "127.0.0.1", 0) as server:
            address = f"tcp://127.0.0.1:{server.sockets[0].getsockname()[1]}"
            session = await aio.connect(address, timeout=0.5)
            begin = asyncio.get_running_loop().time()
            first, second, third = await asyncio.gather(
                *(session.request("act", 1) for _ in range(3)), return_exceptions=True
            )
            assert first == [{"reward": 1}]
            assert re.search("did not answer in time", str(second))
            assert (type(second), type(third)) == (TimeoutError, TimeoutError)
            assert asyncio.get_running_loop().time() - begin > 0.75  # the reply began the time anew
            with pytest.raises(ConnectionError, match="did not answer in time"):
                await session.request("act", 1)
            again = await session.reconnect()
            assert await again.request("act", 1) == [{"reward": 1}]
            await again.close()

    async def test_a_server_that_does_not_greet_is_a_TimeoutError(self):
        async def mute(reader, writer):
            await reader.read()
            writer.close()

        async with await asyncio.start_server(mute, "127.0.0.1", 0) as server:
            with pytest.raises(TimeoutError):
                await aio.connect(f"tcp://127.0.0.1:{server.sockets[0].getsockname()[1]}", timeout=0.2)

    async def test_a_program_that_refuses_its_arguments_is_a_ConnectionError(self):
        with pytest.raises(ConnectionError, match="did not start to serve: .* serve --stdio .*--nope"):
            await aio.launch("--nope")

    async def test_a_session_is_opened_again_only_by_connect(self):
        async with await aio.launch() as session:
            with pytest.raises(ValueError, match=r"reconnect\(\) is not possible"):
                await session.reconnect()

    async def test_other_versions_and_addresses(self):
        for address in ("stdio", "pipes:x", "host:1", "tcp://"):
            with self.subTest(address=address), pytest.raises(ValueError, match="it takes tcp://HOST:PORT"):
                await aio.connect(address)
        with pytest.raises(OSError):
            await aio.connect("unix:/nowhere")
