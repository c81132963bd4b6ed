"""AtariVectorEnv(server=[...]) spreads environments over servers, and goes on when one of them is lost."""

import contextlib
import os
import pathlib
import signal
import tempfile
import threading
import time

import package
import pytest

package.require("gymnasium", "numpy")

import numpy as np
from racebeam import AtariEnv, AtariVectorEnv, InvalidInput, connect
from vector_servers import Compared, halt, server

pytestmark = pytest.mark.needs_program

COUNT = 5  # of which the first server plays three
FIRST, SECOND = np.arange(COUNT) < 3, np.arange(COUNT) >= 3


@pytest.mark.usefixtures("self_cleanup")
class Servers(Compared):
    """Two servers, and environments on them beside the same in this process."""

    @pytest.fixture(autouse=True)
    def set_up(self, cleanup):
        self.servers = contextlib.ExitStack()
        cleanup(self.servers.close)
        (self.one, self.first), (self.two, self.second) = (
            self.servers.enter_context(server("--grace", "1")) for _ in range(2)
        )

    def both(self, count=COUNT, servers=None, **settings):
        settings = {"seed": 5, "repeat_action_probability": 0.25, **settings}
        here = AtariVectorEnv("beamfall", count, **settings)
        there = AtariVectorEnv("beamfall", count, server=servers or [self.one, self.two], **settings)
        self.cleanup(there.close)
        return here, there

    def check(self, shown, expected, rows=None, lost=None):
        """Checks these rows, or all if `rows` is None. `lost` is what the info must say; None if nothing is lost."""
        *arrays, info = shown
        assert np.array_equal(info.pop("lost"), np.zeros(len(arrays[0]), bool) if lost is None else lost)
        if rows is None:
            return super().check((*arrays, info), expected)
        for one, other in zip([*arrays, *info.values()], [*expected[:-1], *expected[-1].values()]):
            assert np.array_equal(one[rows], other[rows])

    @staticmethod
    def kill(process):
        process.kill()
        process.wait()


class TestSame(Servers):
    def test_observations_and_infos(self):
        here, there = self.both(max_num_frames_per_episode=60, obs_type="ram")
        assert self.play(here, there, 40) > COUNT
        mask = np.array([True, False, False, True, False])
        for arguments in (
            {"seed": 2**32 - 3},
            {"options": {"reset_mask": mask}},
            {"seed": [1, None, -1, 9, 2], "options": {"reset_mask": mask}},
        ):
            self.check(there.reset(**arguments), here.reset(**arguments))
            self.play(here, there, 5)
        self.check(there.show(), here.show())

    def test_continuous_actions_and_pictures(self):
        here, there = self.both(
            continuous=True, render_mode="rgb_array", autoreset_mode="SameStep", max_num_frames_per_episode=30
        )
        assert all(map(np.array_equal, there.render(), here.render()))
        self.play(here, there, 20)
        assert all(map(np.array_equal, there.render(), here.render()))

    def test_bad_input_leaves_all_servers_in_step(self, subtests):
        here, there = self.both()
        with pytest.raises(IndexError):
            there.step([0, 0, 0, 0, 99])
        self.play(here, there, 3)
        with pytest.raises(IndexError):
            there.send([99] + [0] * (COUNT - 1))
        self.play(here, there, 3)
        for servers in ([], [3]):
            with subtests.test(servers=servers), pytest.raises(TypeError):
                AtariVectorEnv("beamfall", 2, server=servers)
        with pytest.raises(InvalidInput):
            AtariVectorEnv("beamfall", 2, server=[self.one, self.two], batch_size=1)
        with pytest.raises(ValueError, match="it takes tcp://HOST:PORT"):
            AtariVectorEnv("beamfall", 2, server=[self.one, "udp://nowhere"])

    def test_a_child_after_a_fork_is_refused(self):
        here, there = self.both()
        child = os.fork()
        if child == 0:
            try:
                there.step([0] * COUNT)
            except RuntimeError as error:
                os._exit(7 if "before the process forked" in str(error) else 8)
            os._exit(9)
        assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 7
        self.play(here, there, 2)


class TestHalves(Servers):
    def test_all_servers_play_between_the_halves(self):
        here, there = self.both()
        for step in range(20):
            for envs in (here, there):
                envs.send([step % 3] * COUNT)
            with pytest.raises(InvalidInput, match=f"{COUNT} environments play; receive them first"):
                there.step([0] * COUNT)
            self.check(there.recv(), here.recv())
        for envs in (here, there):
            envs._open_machines().send_resets(np.arange(COUNT) * 7)
        self.check(there.recv(), here.recv())
        self.play(here, there, 5)

    def test_a_server_that_is_lost_between_the_halves(self):
        here, there = self.both(noop_max=0, use_fire_reset=False)
        before = there.step([1] * COUNT)[0]
        here.step([1] * COUNT)
        halt(self.second)
        for envs in (here, there):
            envs.send([0] * COUNT)
        self.kill(self.second)
        result = there.recv()
        assert result[3][SECOND].all() and np.array_equal(result[0][SECOND], before[SECOND])
        self.check(result, here.recv(), FIRST, lost=SECOND)
        self.check(there.step([0] * COUNT), here.step([0] * COUNT), FIRST)

    def test_the_info_has_a_server_lost_before_a_reset(self):
        here, there = self.both()
        halt(self.second)
        for envs in (here, there):
            envs.send([0] * COUNT)
        self.kill(self.second)
        self.check(there.reset(seed=3), here.reset(seed=3), lost=SECOND)
        self.check(there.step([0] * COUNT), here.step([0] * COUNT))


class TestStates(Servers):
    def test_a_state_goes_from_one_server_to_the_other(self):
        here, there = self.both()
        self.play(here, there, 10)
        for envs in (here, there):
            envs.restore(COUNT - 1, envs.save(0))
        self.check(there.show(), here.show())
        self.play(here, there, 20)
        with pytest.raises(IndexError, match=f"environment {COUNT} is out of range"):
            there.save(COUNT)

    def test_a_server_that_is_lost_is_a_ConnectionError_and_the_next_step_goes_on(self):
        here, there = self.both()
        state = there.save(COUNT - 1)
        self.kill(self.second)
        for call in (lambda: there.save(COUNT - 1), lambda: there.restore(COUNT - 1, state)):
            with pytest.raises(ConnectionError):
                call()
        self.check(there.step([0] * COUNT), here.step([0] * COUNT), FIRST, lost=SECOND)
        there.step([0] * COUNT)
        there.restore(COUNT - 1, state)
        assert there.save(COUNT - 1).__getstate__() == state.__getstate__()


class TestLost(Servers):
    def check_truncated(self, shown, before, expected):
        """The second server was lost in this step; `expected` is what the first one shows."""
        observations, rewards, terminated, truncated, info = shown
        assert truncated[SECOND].all() and not terminated[SECOND].any() and not rewards[SECOND].any()
        assert np.array_equal(observations[SECOND], before[SECOND])
        self.check(shown, expected, FIRST, lost=SECOND)

    def test_the_next_step_begins_new_episodes(self):
        here, there = self.both(noop_max=0, use_fire_reset=False)
        self.play(here, there, 20)
        before = there.step([1] * COUNT)[0]
        here.step([1] * COUNT)
        self.kill(self.second)
        self.check_truncated(there.step([0] * COUNT), before, here.step([0] * COUNT))
        observations, rewards, *_, info = result = there.step([0] * COUNT)
        self.check(result, here.step([0] * COUNT), FIRST)
        assert not (rewards[SECOND].any() or info["episode_frame_number"][SECOND].any() or result[3].any())
        assert not np.array_equal(observations[SECOND], before[SECOND])
        for _ in range(50):  # they play on
            result = there.step([1] * COUNT)
            self.check(result, here.step([1] * COUNT), FIRST)
        assert result[-1]["episode_frame_number"][SECOND].all()
        self.check(there.reset(seed=3), here.reset(seed=3))
        self.play(here, there, 5)

    def test_the_same_step_begins_new_episodes(self):
        here, there = self.both(autoreset_mode="SameStep", noop_max=0, use_fire_reset=False)
        self.play(here, there, 20)
        before, _, _, _, infos = there.step([1] * COUNT)
        here.step([1] * COUNT)
        self.kill(self.second)
        observations, rewards, terminated, truncated, info = there.step([0] * COUNT)
        assert (
            np.array_equal(info["lost"], SECOND)
            and np.array_equal(truncated, SECOND)
            and np.array_equal(info["_final_obs"], SECOND)
        )
        for env in np.flatnonzero(SECOND):
            assert np.array_equal(info["final_obs"][env], before[env])
            assert info["final_info"]["frame_number"][env] == infos["frame_number"][env]
        assert not (info["episode_frame_number"][SECOND].any() or rewards[SECOND].any() or terminated.any())
        assert np.array_equal(observations[FIRST], here.step([0] * COUNT)[0][FIRST])
        self.check(there.step([1] * COUNT), here.step([1] * COUNT), FIRST)

    def test_without_autoreset_a_reset_begins_new_episodes(self):
        here, there = self.both(autoreset_mode="Disabled", obs_type="ram")
        self.play(here, there, 20)
        before = there.step([1] * COUNT)[0]
        here.step([1] * COUNT)
        self.kill(self.second)
        self.check_truncated(there.step([0] * COUNT), before, here.step([0] * COUNT))
        self.check(*(envs.reset(options={"reset_mask": SECOND}) for envs in (there, here)), FIRST)
        self.check(there.step([1] * COUNT), here.step([1] * COUNT), FIRST)

    def test_a_server_that_is_told_to_stop_is_lost(self):
        here, there = self.both()
        self.play(here, there, 2)
        self.second.send_signal(signal.SIGTERM)
        losses, until = 0, time.monotonic() + 60
        while not losses and time.monotonic() < until:  # the server's grace is a second
            losses = there.step([0] * COUNT)[-1]["lost"].sum()
        assert losses == SECOND.sum()
        assert not there.step([0] * COUNT)[-1]["lost"].any()

    def test_a_server_that_does_not_answer_in_time_is_lost(self):
        _, there = self.both(timeout=5)  # within which the first answers, though the machine is busy
        halt(self.second)
        assert there.step([0] * COUNT)[-1]["lost"].tolist() == SECOND.tolist()
        assert not there.step([0] * COUNT)[-1]["lost"].any()

    def test_the_info_has_a_loss_in_a_reset(self):
        here, there = self.both()
        self.kill(self.first)
        self.check(there.reset(seed=9), here.reset(seed=9), lost=FIRST)
        self.play(here, there, 5)

    def test_spare_servers_come_first(self):
        here, there = self.both(
            count=2, servers=[self.one, self.two, self.servers.enter_context(server("--max-machines", "1"))[0]]
        )
        self.kill(self.first)
        there.step([0, 0])
        self.kill(self.second)  # the spare one plays the first environment, and may play the other, too
        assert there.step([0, 0])[-1]["lost"].tolist() == [False, True]
        assert not there.step([0, 0])[-1]["lost"].any()

    def test_a_server_that_is_absent_at_the_start(self, cleanup):
        with tempfile.TemporaryDirectory() as folder:
            file, never = pathlib.Path(folder, "late"), f"file:{folder}/never?wait=0.5"
            late = threading.Timer(0.2, lambda: file.write_text(f"{self.two}\n"))
            late.start()
            cleanup(late.join)
            addresses = [f"file:{file}?wait=60", "tcp://127.0.0.1:1", never]
            with pytest.warns(RuntimeWarning) as warned:
                here, there = self.both(count=6, servers=addresses)
        assert [str(each.message).replace(folder, "") for each in warned.list] == [
            (
                "environments 2 to 3 begin on file:/late?wait=60: no server answers at tcp://127.0.0.1:1: "
                "Connection refused"
            ),
            (
                "environments 4 to 5 begin on file:/late?wait=60: no server answers at file:/never: No such "
                "file or directory"
            ),
        ]
        assert [each.filename for each in warned.list] == [__file__] * 2
        self.check(there.reset(), here.reset(), lost=[False] * 2 + [True] * 4)
        self.play(here, there, 20)  # with the seeds that they would have had

    def test_a_step_reports_an_absent_server_too(self):
        with pytest.warns(RuntimeWarning):
            here, there = self.both(servers=[self.one, "unix:/nonexistent"])
        self.check(there.step([1] * COUNT), here.step([1] * COUNT), lost=SECOND)
        self.play(here, there, 5)

    def test_a_busy_server_is_absent(self):
        busy, _ = self.servers.enter_context(server("--max-sessions", "1"))
        with connect(busy), pytest.warns(RuntimeWarning, match="environments 3 to 4 .*busy: there are 1 sessions"):
            self.both(servers=[self.one, busy])

    def test_without_any_server_the_addresses_are_named(self):
        missing = ["tcp://127.0.0.1:1", "unix:/nonexistent", "file:/nonexistent"]  # the last one is spare
        with pytest.raises(
            ConnectionError,
            match="no server is left for environments 0 to 0: "
            + "; ".join(f"no server answers at {address}: [^;]*" for address in missing),
        ):
            AtariVectorEnv("beamfall", 2, server=missing)
        for make in (lambda **how: AtariVectorEnv("beamfall", 2, **how), lambda **how: AtariEnv("beamfall", **how)):
            with pytest.raises(ConnectionError, match="no server answers at tcp://127.0.0.1:1: .*refused"):
                make(server="tcp://127.0.0.1:1")

    def test_without_a_server_it_is_a_ConnectionError(self):
        _, there = self.both()
        for process in (self.first, self.second):
            self.kill(process)
        for call in (lambda: there.step([0] * COUNT), there.reset, there.show):
            with pytest.raises(ConnectionError, match="no server is left for environments 0 to 2"):
                call()
