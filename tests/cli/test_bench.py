"""racebeam bench: its report, and the effect of its settings."""

import json

import pytest
from harness import GAME, run

FIELDS = {
    "game",
    "md5",
    "frames",
    "acts",
    "frame_skip",
    "cpu_seconds",
    "frames_per_second",
    "resets",
    "reset_cpu_seconds",
    "screen",
    "screens",
    "audio",
    "reward",
    "last_screen_crc",
    "last_ram_crc",
}


def bench(*words, data=b""):
    status, printed, errors = run("bench", "--rom", GAME, "--json", *words, data=data)
    assert (status, errors) == (0, []), errors
    return json.loads(printed)


def commands(*lines):
    status, printed, errors = run("bench", "--rom", GAME, "--commands", data="\n".join(lines).encode())
    assert (status, errors) == (0, []), errors
    return [json.loads(line) for line in printed.splitlines()]


def work(figures):
    return [figures[key] for key in ("frames", "reward", "resets", "last_screen_crc", "last_ram_crc")]


class TestBench:
    def test_it_reports_what_was_done_and_how_long_it_took(self):
        figures = bench("--frames", "600")
        assert set(figures) == FIELDS
        assert (figures["frames"], figures["acts"], figures["screens"]) == (600, 600, 600)
        assert figures["cpu_seconds"] > 0
        assert abs(figures["frames_per_second"] - 600 / figures["cpu_seconds"]) <= 1

    def test_all_kinds_of_screens_come_from_the_same_play(self):
        every, last, none = (
            bench("--frames", "600", "--frame-skip", "4", "--screen", screen) for screen in ("every", "last", "none")
        )
        assert [every["screens"], last["screens"], none["screens"]] == [600, 150, 0]
        assert work(every) == work(last)
        assert work(every) == work(none)

    def test_the_actions_of_a_file_are_those_that_trace_plays(self):
        actions = b"1 1 3 3 11 11 4 4 12 2 10 5"
        figures = bench("--frames", "12", "--actions", "-", data=actions)
        _, lines, _ = run("trace", "--rom", GAME, "--actions", "-", data=actions)
        last = lines.decode().splitlines()[-1].split()
        assert [figures["last_ram_crc"], figures["last_screen_crc"]] == last[-2:]

    def test_actions_start_over_when_they_run_out(self):
        assert work(bench("--frames", "24", "--actions", "-", data=b"1 3 4")) == work(
            bench("--frames", "24", "--actions", "-", data=b"1 3 4" + b" 1 3 4" * 7)
        )

    def test_snapshots_are_timed_when_asked_for(self):
        figures = bench("--frames", "10", "--save-restore")
        assert figures["machine_state_bytes"] <= 2048
        assert figures["client_save_restore_ns"] > figures["machine_save_restore_ns"]

    def test_commands_are_answered_line_by_line(self):
        play, check, reset, save = commands("play 1 3 3 4", "check 4 4", "reset 2", "save 10")
        assert (play["frames"], play["resets"]) == (4, 0)
        assert play["seconds"] > 0
        assert (check["frames"], set(check) >= {"digest", "reward"}) == (2, True)
        assert reset["seconds"] > 0
        assert min(save["seconds"], save["machine_seconds"]) > 0

    def test_what_is_checked_is_what_is_played(self):
        actions = "1 3 3 4 11 11 " * 300  # resets included
        played, checked = commands("play " + actions)[0], commands("check " + actions, "play 0")
        for key in ("frames", "reward", "resets"):
            assert played[key] == checked[0][key]
        assert commands("play " + actions, "play 0")[1]["ram"] == checked[1]["ram"]

    def test_the_checksum_is_of_every_act(self):
        def digest(actions, *words):
            return commands("check " + actions, *words)[0]["digest"]

        assert digest("1 3 3 4") == digest("1 3 3 4")
        assert digest("1 3 3 4 0") != digest("1 3 3 4")
        _, printed, _ = run("bench", "--rom", GAME, "--commands", "--screen", "none", data=b"check 1 3 3 4")
        assert json.loads(printed)["digest"] != digest("1 3 3 4")

    def test_unknown_commands_are_refused(self, subtests):
        for line in ("dance 1", "play", "play left", "reset 0", "save 1 2"):
            with subtests.test(line=line):
                status, _, errors = run("bench", "--rom", GAME, "--commands", data=line.encode())
                assert (status, len(errors)) == (1, 1), errors
                assert f"unknown command '{line}'; accepted: play A..., check A..., reset N and save N" in errors[0]
        status, _, errors = run("bench", "--rom", GAME, "--commands", "--frame-skip", "4", data=b"play 1")
        assert status == 1
        assert "give --screen last or none with --frame-skip 4" in errors[0]

    def test_the_text_names_the_same_figures(self):
        status, printed, errors = run("bench", "--rom", GAME, "--frames", "60", "--audio")
        assert (status, errors) == (0, [])
        lines = dict(line.split(None, 1) for line in printed.decode().splitlines())
        assert (lines["game"], lines["audio"]) == ("beamfall", "yes")

    def test_steps_of_very_many_frames_are_counted(self):
        status, _, errors = run(
            "bench", "--rom", GAME, "--batch", "4", "--threads", "1", "--frame-skip", str(2**30), "--frames", "10"
        )
        assert (status, errors) == (0, [])

    @pytest.mark.parametrize(
        "data, complaint",
        (
            (b"", "'-' has no actions"),
            (b"x", "line 1: 'x' is not a number"),
            (b"99", "99"),
            (b"3\n3@0.5", "line 2: only actions are accepted here"),
            (b"3\nM 0 1", "line 2: only actions are accepted here"),
        ),
    )
    def test_no_actions_and_wrong_ones_are_refused(self, data, complaint):
        status, printed, errors = run("bench", "--rom", GAME, "--actions", "-", data=data)
        assert (status, printed, len(errors)) == (1, b"", 1), errors
        assert complaint in errors[0]
