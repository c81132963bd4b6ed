"""Sessions for asyncio answer what sessions answer, in order, and end with an error that says why."""

import asyncio
import unittest

import package

package.require("numpy")

import racebeam
from racebeam.wire import aio

LOAD = ("load", "beamfall")
SETTINGS = {"seed": 7, "frame_skip": 4}
FIELDS = ("reward", "ends", "screen:delta", "grey84x4:raw", "ram:raw")


def plain(values):
    return [{key: value.tolist() if hasattr(value, "tolist") else value for key, value in group.items()} for group in values]


class Sessions(unittest.IsolatedAsyncioTestCase):
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
        self.assertEqual([plain(answer) for answer in answers], [plain(answer) for answer in expected])

    async def test_a_refusal_is_its_requests_alone(self):
        good, bad, after = await asyncio.gather(*(self.session.request("act", action) for action in (1, 99, 1)), return_exceptions=True)
        self.assertEqual((bad.code, set(good[0])), ("bad-action", set(after[0])))

    async def test_a_request_that_is_cancelled_leaves_the_others(self):
        given_up, kept = (asyncio.create_task(self.session.request("act", action)) for action in ("0*3000", "1"))
        await asyncio.sleep(0)
        given_up.cancel()
        self.assertIn("reward", (await kept)[0])
        self.assertTrue(given_up.cancelled())

    async def test_it_ends(self):
        waiting = asyncio.create_task(self.session.request("act", "0*10000"))
        await asyncio.sleep(0)
        await self.session.close()
        await self.session.close()
        for request in (waiting, self.session.request("act", 1)):
            with self.assertRaises(ConnectionError):
                await request


class Ends(unittest.IsolatedAsyncioTestCase):
    async def check(self, said, *expected, **settings):
        """A server that says this after the greeting, and closes."""
        async def answer(reader, writer):
            await reader.readline()
            writer.write(b"ok protocol=1\n")
            await reader.readline()
            writer.write(said)
            await writer.drain()
            writer.close()
        async with await asyncio.start_server(answer, "127.0.0.1", 0) as server:
            port = server.sockets[0].getsockname()[1]
            async with await aio.connect(f"tcp://127.0.0.1:{port}", **settings) as session:
                with self.assertRaisesRegex(*expected):
                    await session.request("look", "ram:raw")

    async def test_a_server_that_goes_is_a_ConnectionError(self):
        for said in (b"", b"ok ram=12", b"ok ram=4 raw=4\nab", b"no\n", b"ok ram=9 raw=3\nabc", b"ok ram=x raw=3\nabc", b"ok ram=1 raw=3\nabc",
                     b"ok ram=1 raw=99999999999\n"):
            with self.subTest(said=said):
                await self.check(said, ConnectionError, "has ended")

    async def test_a_line_that_is_too_long_is_one_too(self):
        await self.check(b"ok " + b"x" * 5000, ConnectionError, "has ended", longest_reply=1000)

    async def test_other_versions_and_addresses(self):
        for address in ("stdio", "pipes:x", "host:1", "tcp://"):
            with self.subTest(address=address), self.assertRaisesRegex(ValueError, "it takes tcp://HOST:PORT"):
                await aio.connect(address)
        with self.assertRaises(OSError):
            await aio.connect("unix:/nowhere")


if __name__ == "__main__":
    package.main()
