"""Words of requests and replies, streams that end or are slow, and replies that are read in two ways."""

import enum
import io
import pickle
import socket
import threading

import package
import pytest

package.require("numpy", "gymnasium")

import numpy as np
from racebeam.vector.results import Results
from racebeam.wire.connection import Connection
from racebeam.wire.last_reply import LastReply
from racebeam.wire.messages import (
    Refused,
    Reply,
    format_request,
    format_word,
    key_values,
    optional_words,
    parse_count,
    parse_groups,
    parse_number,
)
from racebeam.wire.transport import MOST_UNSENT, SocketStream


class TestWords:
    def test_only_what_looks_like_a_number_is_one(self):
        for text, value in (
            ("0", 0),
            ("-7", -7),
            ("0.25", 0.25),
            ("999999999999999", 999999999999999),
            ("1000000000000000", "1000000000000000"),
            ("0046", "0046"),
            ("1e3", "1e3"),
            (".5", ".5"),
            ("", ""),
            ("pong", "pong"),
        ):
            found = parse_number(text)
            assert (found, type(found)) == (value, type(value))

    def test_groups_have_the_values_by_key(self):
        assert parse_groups("machines=2 | a=1 b=x=y | a=2 word") == [
            {"machines": "2"},
            {"a": "1", "b": "x=y"},
            {"a": "2"},
        ]
        assert parse_groups("") == [{}]
        assert parse_groups("| a=1") == [{}, {"a": "1"}]

    def test_a_count_is_from_0_to_the_limit(self):
        assert [parse_count(text, 5) for text in ("0", "5", "05")] == [0, 5, 5]
        for text in ("6", "-1", "", "x", "1.0"):
            with pytest.raises(ValueError, match="bytes follow its reply; the limit is 5"):
                parse_count(text, 5)

    def test_a_refusal_has_a_code_and_a_sentence(self):
        refused = Refused("bad-value", "seed is x")
        for copy in (refused, pickle.loads(pickle.dumps(refused))):
            assert (copy.code, copy.sentence, str(copy)) == ("bad-value", "seed is x", "bad-value: seed is x")
            assert copy.args == ("bad-value", "seed is x")

    def test_a_request_is_one_line(self):
        assert [format_word(value) for value in (True, False, 2, "x", 0.5)] == ["1", "0", "2", "x", "0.5"]

    def test_a_member_of_an_enumeration_is_sent_as_its_value(self):
        assert [format_word(member) for member in enum.Enum("Buttons", {"A": 4, "B": "FIRE"})] == ["4", "FIRE"]
        assert (optional_words(None), optional_words(0)) == ([], [0])
        assert key_values(a=True, b=None, c=0) == ["a=1", "c=0"]
        assert format_request(["load", "pong"], {"seed": 5, "sticky": None}) == "load pong seed=5"
        assert format_request(["look", "#x"], {}) == "look #x"
        for words in (["a\nb"], ["#a"], ["", "#a"]):
            with pytest.raises(ValueError, match="a request is one line that does not begin with #"):
                format_request(words, {})


class TestConnection:
    def connection(self, data):
        self.closed = 0

        def close():
            self.closed += 1

        made = Connection(io.BytesIO(data), io.BytesIO(), close)
        made.address, made.longest_reply = "tcp://a:1", 8
        return made

    def test_a_reply_at_its_limit_is_read_and_a_longer_one_ends_the_session(self):
        assert self.connection(b"1234567\nrest")._read_line() == "1234567"
        made = self.connection(b"12345678\n")
        with pytest.raises(ConnectionError, match="at tcp://a:1 has ended: its reply is longer than 8 bytes"):
            made._read_line()
        assert self.closed == 1

    def test_half_a_line_and_too_few_bytes_end_the_session(self):
        assert self.connection(b"abc")._read_bytes(3) == b"abc"
        for read in (lambda made: made._read_line(), lambda made: made._read_bytes(4)):
            made = self.connection(b"abc")
            with pytest.raises(ConnectionError, match="^the session of the server at tcp://a:1 has ended$"):
                read(made)
            with pytest.raises(ConnectionError, match="^the session of the server at tcp://a:1 has ended$"):
                made._check()
            made.close_connection()
            assert self.closed == 1

    def test_an_interrupted_session_says_so(self):
        made = self.connection(b"")

        def interrupt():
            raise KeyboardInterrupt

        with pytest.raises(KeyboardInterrupt):
            made._abort_on_interrupt(interrupt)
        with pytest.raises(ConnectionError, match="it was interrupted between a request and the end of its reply"):
            made._check()
        made = self.connection(b"")
        assert made._abort_on_interrupt(lambda: 5) == 5
        with pytest.raises(Refused):
            made._abort_on_interrupt(lambda: (_ for _ in ()).throw(Refused("bad-value", "x")))
        made._check()

    def test_a_child_process_neither_uses_nor_closes_the_session(self):
        made = self.connection(b"")
        made._process += 1
        with pytest.raises(RuntimeError, match="was opened before the process forked; open a new one"):
            made._check()
        made.close_connection()
        assert self.closed == 0

    def test_the_first_reason_stays_and_a_late_answer_is_a_TimeoutError(self):
        made = self.connection(b"")
        assert isinstance(made._fail(TimeoutError()), TimeoutError)
        made._abort()
        with pytest.raises(ConnectionError, match="the server at tcp://a:1 did not answer in time"):
            made._check()
        made = self.connection(b"")
        made._check()
        made.close_connection()
        with pytest.raises(ConnectionError, match="the session was closed"):
            made._check()


class TestStreams:
    @pytest.fixture(autouse=True)
    def set_up(self, cleanup):
        near, self.far = socket.socketpair()
        near.settimeout(60)
        self.far.settimeout(60)
        self.stream = SocketStream(near)
        cleanup(self.stream.close)
        cleanup(self.far.close)

    def test_requests_are_gathered_until_they_are_many(self):
        self.stream.write(b"x" * MOST_UNSENT)
        self.far.setblocking(False)
        with pytest.raises(BlockingIOError):
            self.far.recv(1)
        self.stream.write(b"y")
        assert self.far.recv(2 * MOST_UNSENT) == b"x" * MOST_UNSENT + b"y"
        self.stream.write(b"z")
        self.stream.flush()
        self.stream.flush()
        assert self.far.recv(2) == b"z"

    def test_lines_and_bytes_come_in_any_pieces(self):
        self.far.sendall(b"one\ntwo\nabcdefth")
        assert [self.stream.readline(99), self.stream.readline(99)] == [b"one\n", b"two\n"]
        assert self.stream.read(2) == b"ab"
        assert self.stream.read(0) == b""
        sender = threading.Thread(target=lambda: [self.far.sendall(part) for part in (b"ree", b"\nfo", b"ur\n")])
        assert self.stream.read(4) == b"cdef"
        sender.start()
        assert [self.stream.readline(99), self.stream.readline(99)] == [b"three\n", b"four\n"]
        sender.join()
        assert self.stream.connection.gettimeout() == 60

    def test_a_line_is_read_up_to_its_limit(self):
        self.far.sendall(b"x" * 10)
        assert self.stream.readline(10) == b"x" * 10
        self.far.sendall(b"\n")
        assert self.stream.readline(10) == b"\n"

    def test_the_end_leaves_what_came_before(self):
        self.far.sendall(b"abcde")
        self.far.shutdown(socket.SHUT_WR)
        assert self.stream.read(2) == b"ab"
        assert self.stream.readline(99) == b"cde"
        assert self.stream.read(3) == b""

    def test_a_silent_server_is_a_TimeoutError(self):
        self.stream._limit = 0.01
        for read in (lambda: self.stream.readline(9), lambda: self.stream.read(1)):
            with pytest.raises(TimeoutError):
                read()


class Session:
    """Decodes the replies of this file."""

    def _decode_plain(self, reply):
        groups, at = [], 0
        for texts in parse_groups(reply.text):
            values = {key: parse_number(text) for key, text in texts.items()}
            for key in ("ram", "final_ram"):
                if key in values:
                    at, values[key] = at + values[key], reply.data[at : at + values[key]]
            groups.append(values)
        return groups


class TestLastReply:
    TEXT = (
        "machines=2 | reward=1 raw_reward=10 lives=2 frame=7 episode_frame=5 terminated=1 truncated=0 game_over=0 ram=2"
        " | reward=-1 raw_reward=-20 lives=3 frame=8 episode_frame=6 terminated=0 truncated=1 game_over=1 ram=2 raw=4"
    )
    FINAL = " final_lives=9 final_frame=8 final_episode_frame=7 final_ram=2 raw=6"

    def filled(self, text=TEXT, data=b"abcd", fill="fill"):
        results = Results.allocate(None, np.zeros((2, 2), np.uint8), 2, np.zeros((2, 2), np.uint8))
        results.numbers[:] = results.final_numbers[:] = -9
        results.flags[:] = fill != "fill_finals"
        reply = LastReply(Session(), 2, "ram")
        reply.keep(Reply(["step"], text, data))
        getattr(reply, fill)(results)
        return results

    def test_a_reply_is_read_as_a_whole_and_field_by_field_alike(self):
        for results in (
            self.filled(),
            self.filled(fill="_fill_each"),
            self.filled(self.TEXT.replace("raw=4", "x=y raw=4")),
        ):
            results.env_id[:] = (0, 1)
            assert results.numbers.tolist() == [[1, -1], [10, -20], [2, 3], [7, 8], [5, 6], [0, 1]]
            assert results.flags.tolist() == [[True, False], [False, True], [False, False], [False, True]]
            assert results.ram.tobytes() == b"abcd"

    def test_only_a_reply_of_exactly_the_observed_fields_is_read_as_a_whole(self):
        results = Results.allocate(None, np.zeros((2, 2), np.uint8), 2, None)
        for text, data, whole in (
            (self.TEXT, b"abcd", True),
            (self.TEXT, b"abc", False),
            (self.TEXT.replace("ram=2 raw", "ram=3 raw"), b"abcd", False),
            (self.TEXT.replace("ram=2 |", "ram=3 |").replace("ram=2 raw", "ram=1 raw"), b"abcd", False),
            (self.TEXT.replace("raw=4", "x=1 raw=4"), b"abcd", False),
            (self.TEXT.replace("reward=1 ", "reward=0.5 "), b"abcd", False),
        ):
            assert LastReply(Session(), 2, "ram")._fill_at_once(Reply(["step"], text, data), results) == whole

    def test_environments_are_numbered(self):
        assert self.filled().env_id.tolist() == [0, 1]

    def test_an_episode_that_ended_has_final_values(self):
        results = self.filled(self.TEXT.replace(" raw=4", self.FINAL), b"abcdef")
        assert results.finished.tolist() == [False, True]
        assert results.final_numbers.tolist() == [[-9, 9], [-9, 8], [-9, 7]]
        assert results.final_observations.tobytes() == b"\0\0ef"

    def test_all_episodes_may_have_ended_with_a_reply(self):
        results = self.filled(fill="fill_finals")
        assert results.finished.tolist() == [True, True]
        assert results.final_numbers.tolist() == [[2, 3], [7, 8], [5, 6]]
        assert results.final_observations.tobytes() == b"abcd"

    def test_values_are_decoded_once_and_may_be_changed(self):
        reply = LastReply(Session(), 2, "ram")
        assert reply.values == []
        reply.keep(Reply(["step"], self.TEXT, b"abcd"))
        reply.values[0]["lives"] = 1
        assert [values["lives"] for values in reply.values] == [1, 3]
        reply.values = [{"rgb": bytes(range(240)) * 4}]
        assert reply.screen(0).shape == (2, 160, 3)
