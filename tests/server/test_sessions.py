"""Small cases of the classic protocol over every transport, and clients that leave, stall or send invalid
lines."""

import contextlib
import os

import pytest
from harness import SOCKETS, STREAMS, TRANSPORTS, Session, rom, sanitized, thread_sanitized

MEBIBYTE = 1 << 20


def converse(transport, data, *options, **image):
    """Sends `data` and closes. Returns the output, the exit status and the log."""
    with Session(transport, "--seed", "123", "--sticky", "0", *options, **image) as session:
        session.wire.send(data)
        session.wire.stop_sending()
        received = session.wire.rest()
        return received, session.status(), session.server.log()


@pytest.mark.usefixtures("self_subtests")
class TestSmallCases:
    def check(self, data, lines, *options, **image):
        expected = "".join(line + "\n" for line in ["160-210", *lines]).encode()
        for transport in TRANSPORTS:
            with self.subtests.test(transport=transport):
                received, status, _ = converse(transport, data, *options, **image)
                assert (received, status) == (expected, 0)

    def test_a_client_that_closes_at_once_hears_DIE(self):
        self.check(b"", ["DIE"])

    def test_a_last_line_without_LF_is_answered_by_DIE(self):
        self.check(b"0,0,0,1\n3,18", ["0,0:", "DIE"])

    def test_without_flags_lines_are_empty(self):
        self.check(b"0,0,0,0\n3,18\n3,18\n", ["", "", "", "DIE"])

    def test_five_frames_are_five_lines(self):
        self.check(b"0,0,0,1\n" + b"3,18\n" * 6, ["0,0:"] * 5 + ["DIE"], "--max-frames", "5")

    def test_five_frames_are_two_lines_with_a_frame_skip_of_four(self):
        self.check(b"0,0,0,1\n" + b"3,18\n" * 6, ["0,0:"] * 2 + ["DIE"], "--max-frames", "5", "--frame-skip", "4")

    def test_an_episode_ends_after_its_frames_until_a_reset(self):
        self.check(
            b"0,0,0,1\n" + b"3,18\n" * 5 + b"45,18\n3,18\n",
            ["0,0:"] * 3 + ["1,0:"] * 3 + ["0,0:"] * 2 + ["DIE"],
            "--max-episode-frames",
            "3",
        )

    @pytest.mark.needs_roms("breakout")
    def test_a_paddle_game_takes_every_number_for_nothing(self):
        self.check(b"0,0,0,1\n1,0\n45,45\n0,0\n99,99\n-5,3\n", ["0,0:"] * 6 + ["DIE"], image=rom("breakout"))

    @pytest.mark.needs_roms("seaquest")
    def test_one_generator_fills_the_memory_and_it_is_the_one_of_the_seed(self):
        def memory(seed, system_seed):
            words = ("--seed", seed, "--system-seed", system_seed, "--sticky", "0")
            with Session("stdio", *words, image=rom("seaquest")) as session:
                session.wire.send(b"0,1,0,0\n")
                return session.wire.receive(len(b"160-210\n") + 258)

        assert memory("1", "1") == memory("1", "2")
        assert memory("1", "1") != memory("2", "1")

    def test_line_ends_of_other_systems_do_no_harm(self):
        self.check(b"0,0,0,1\r\n3,18\r\n 3 , 18 \r\n", ["0,0:"] * 3 + ["DIE"])


@pytest.mark.usefixtures("self_subtests")
class TestNonsense:
    def check(self, data, lines, status, complaint):
        expected = "".join(line + "\n" for line in ["160-210", *lines]).encode()
        for transport in TRANSPORTS:
            with self.subtests.test(transport=transport):
                received, ended, log = converse(transport, data)
                assert received == expected
                assert ended == (status if transport in ("stdio", "pipes") else 0)
                assert len([line for line in log if complaint in line]) == 1, log

    def test_an_action_that_does_not_exist_ends_the_session(self):
        self.check(b"0,0,0,1\n3,18\n99,18\n3,18\n", ["0,0:"] * 2, 255, "asked for action 99")

    def test_flags_that_are_too_few_end_the_session(self):
        self.check(b"0,0,1\n", [], 1, "3 numbers")

    def test_an_empty_line_instead_of_an_action_ends_the_session(self):
        self.check(b"0,0,0,1\n\n3,18\n", ["0,0:"], 1, "0 numbers")

    def test_loading_what_was_never_saved_ends_the_session(self):
        self.check(b"0,0,0,1\n44,18\n", ["0,0:"], 1, "none that it saved")

    def test_bytes_that_are_not_text_end_the_session(self):
        self.check(b"0,0,0,1\n" + bytes(range(128, 256)) + b"\n", ["0,0:"], 1, "1 numbers")

    @pytest.mark.parametrize("transport", TRANSPORTS)
    def test_a_line_of_a_mebibyte_without_a_comma_ends_the_session(self, transport):
        with Session(transport) as session:
            with contextlib.suppress(BrokenPipeError, ConnectionResetError):  # the server need not read all of it
                session.wire.send(b"0,0,0,1\n" + b"3" * MEBIBYTE + b"\n")
            assert session.wire.rest()[:13] == b"160-210\n0,0:\n"
            assert session.status() == (1 if transport in ("stdio", "pipes") else 0)
            assert len([line for line in session.server.log() if "1 numbers" in line]) == 1

    def test_a_line_of_a_mebibyte_of_numbers_is_taken_for_many(self):
        received, status, _ = converse("stdio", b"0,0,0,1\n" + b"3," * (MEBIBYTE // 2) + b"\n")
        pieces = MEBIBYTE // 2047 + 1  # one read of the classic server takes 2047 bytes
        assert (received, status) == (b"160-210\n" + b"0,0:\n" * (pieces + 1) + b"DIE\n", 0)


class TestLeaving:
    SAID = b"0,0,0,1\n3,18\n43,18\n4,18\n44,18\n45,45\n"

    @pytest.mark.parametrize("transport", TRANSPORTS)
    @pytest.mark.parametrize("count", range(len(SAID) + 1))
    def test_the_client_may_stop_sending_after_any_byte(self, transport, count):
        self.check_sent(transport, self.SAID[:count])

    def check_sent(self, transport, data):
        received, status, log = converse(transport, data)
        # A last line that is too short is refused; all others are executed.
        last, numbers = data.split(b"\n")[-1], 2 if b"\n" in data else 4
        is_cut = bool(last) and len([part for part in last.split(b",") if part]) < numbers
        assert received.endswith(b"DIE\n") == (not is_cut)
        assert received.count(b"0,0:\n") == data.count(b"\n")
        assert len([line for line in log if "numbers" in line]) == (1 if is_cut else 0), log
        assert status == (1 if is_cut and transport in ("stdio", "pipes") else 0)

    def test_the_client_may_stop_reading_after_any_byte(self, subtests):
        answers = b"160-210\n" + b"0,0:\n" * 6
        for transport in TRANSPORTS:
            for count in range(len(answers)):
                with subtests.test(transport=transport, count=count):
                    self.check_heard(transport, answers, count)

    def check_heard(self, transport, answers, count):
        lines = answers[:count].count(b"\n")  # this many complete replies were received
        requests = self.SAID.splitlines(keepends=True)
        with Session(transport, "--seed", "1", "--sticky", "0") as session:
            wire = session.wire
            wire.send(b"".join(requests[:lines]))
            assert wire.receive(count) == answers[:count]
            if transport in ("stdio", "pipes"):
                wire.stop_reading()
                wire.send(b"3,18\n" if lines else b"0,0,0,1\n")
                assert session.status() == 1
                assert session.server.log()[-1] == "racebeam: the client stopped reading"
            else:
                wire.close()
                self.assert_serves(session)

    @pytest.mark.needs_posix
    @pytest.mark.parametrize("transport", TRANSPORTS)
    def test_the_client_may_leave_in_the_middle_of_an_act(self, transport, tmp_path):
        image = tmp_path / "endless.bin"  # JMP to itself: frames that take long
        image.write_bytes(b"\x4c\x00\xf0".ljust(4090, b"\0") + b"\x00\xf0" * 3)
        with Session(transport, "--frame-skip", "100000", image=str(image)) as session:
            wire = session.wire
            assert wire.line().startswith(b"160-")
            wire.send(b"0,0,0,1\n3,18\n")
            wire.line()
            session.server.wait_until_it_works()
            wire.close()
            if transport in STREAMS:
                assert session.server.wait() == 1
                assert session.server.log()[-1] == "racebeam: the client stopped reading"
            else:
                session.server.wait_for("client 1: the client left in the middle of an act$")

    def assert_serves(self, session):
        """Another client has a whole session with the same server."""
        wire = session.connect()
        wire.send(self.SAID)
        wire.stop_sending()
        assert wire.rest() == b"160-210\n" + b"0,0:\n" * 6 + b"DIE\n"
        wire.close()
        assert session.server.alive()


class TestStalling:
    AHEAD = b"1,1,0,1\n" + b"3,18\n" * 1000

    def stall(self, session):
        """Requests 67 MB of screens, and reads none of them."""
        session.wire.send(self.AHEAD)

    def memory(self, session):
        with open(f"/proc/{session.server.process.pid}/statm") as numbers:
            return int(numbers.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")

    @pytest.mark.parametrize("transport", TRANSPORTS)
    def test_a_client_that_does_not_read_is_waited_for(self, transport):
        with Session(transport, "--full-screen") as session:
            before = self.memory(session)
            self.stall(session)
            session.wire.receive(100)
            if not sanitized():  # most of it is the sanitizer's
                assert self.memory(session) - before < (64 if thread_sanitized() else 32) << 20
            session.wire.stop_sending()
            answers = session.wire.rest()
            assert (answers.count(b":\n"), answers[-4:]) == (1001, b"DIE\n")

    @pytest.mark.parametrize("transport", STREAMS)
    def test_a_client_that_leaves_with_a_full_pipe_ends_its_session(self, transport):
        with Session(transport, "--full-screen") as session:
            self.stall(session)
            session.wire.receive(100)
            session.wire.stop_reading()
            assert session.status() == 1
            assert session.server.log()[-1] == "racebeam: the client stopped reading"

    @pytest.mark.parametrize("transport", SOCKETS)
    def test_clients_that_do_not_read_hold_nobody_up(self, transport):
        with Session(transport, "--full-screen", "--seed", "1") as session:
            stalled = [session.wire] + [session.connect() for _ in range(15)]
            for wire in stalled:
                wire.send(self.AHEAD)
            other = session.connect()
            other.send(b"0,0,0,1\n" + b"3,18\n" * 100)
            other.stop_sending()
            assert other.rest().endswith(b"DIE\n")
            for wire in stalled + [other]:
                wire.close()
            session.wire = session.connect()
            assert session.wire.line() == b"160-210\n"
