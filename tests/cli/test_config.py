"""racebeam config: values and their sources, in their precedence."""

import os
import subprocess

import pytest

BINARY = os.environ.get("RACEBEAM_BINARY", "build/release/racebeam")


@pytest.mark.usefixtures("self_folder")
class TestConfig:
    def file(self, text):
        path = os.path.join(self.folder, "settings.toml")
        with open(path, "w") as file:
            file.write(text)
        return path

    def run_racebeam(self, *words, data=b"", **variables):
        environment = {name: value for name, value in os.environ.items() if not name.startswith("RACEBEAM_")}
        return subprocess.run(
            [BINARY, *words],
            input=data,
            capture_output=True,
            env={**environment, **variables},
            cwd=self.folder,
            timeout=20,
        )

    def settings(self, *words, **variables):
        done = self.run_racebeam("config", *words, **variables)
        assert (done.returncode, done.stderr) == (0, b"")
        lines = [line.rsplit("  # ", 1) for line in done.stdout.decode().splitlines()]
        return {line.split(" =")[0]: (line.split("=", 1)[1].strip(), source) for line, source in lines}

    def test_threads_are_as_many_as_the_processors_that_may_be_used(self, cleanup):
        allowed = os.sched_getaffinity(0)
        cleanup(os.sched_setaffinity, 0, allowed)
        for processors in (allowed, {min(allowed)}):
            os.sched_setaffinity(0, processors)  # a child has it too
            found = self.settings("--stdio")["threads"]
            assert int(found[0]) <= len(processors)  # a quota may allow fewer
            assert found[1] == "default"

    def test_memory_is_given_in_bytes_or_with_a_unit(self):
        for text, bytes_of in (("123456789", 123456789), ("512M", 512 << 20), ("2G", 2 << 30), ("64 kb", 64 << 10)):
            assert self.settings("--stdio", "--max-memory", text)["max_memory"] == (str(bytes_of), "command line")
        default = int(self.settings("--stdio")["max_memory"][0])
        physical = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
        assert default <= physical * 3 // 4
        assert default > 1 << 26
        assert self.run_racebeam("config", "--stdio", "--max-memory", "much").returncode == 2

    @pytest.mark.parametrize(
        "text, size",
        (
            ("0", 0),
            ("1b", 1),
            ("3k", 3 << 10),
            ("3 KB", 3 << 10),
            ("3  kiB", 3 << 10),
            ("5MiB", 5 << 20),
            ("7g", 7 << 30),
            ("9TB", 9 << 40),
            ("1023P", 1023 << 50),
            ("1024p", 1 << 60),
            ("1E", 1 << 60),
            (str(1 << 60), 1 << 60),
        ),
    )
    def test_a_size_has_any_unit_up_to_the_largest_size(self, text, size):
        value, source = self.settings("--max-memory", text)["max_memory"]
        assert (value.strip('"'), source) == (str(size), "command line")  # large numbers are written as texts

    @pytest.mark.parametrize(
        "text", ("K", "1x", "1kk", "1ib", "1 k b", "k1", "-1", "1.5k", "2E", "1025P", str((1 << 60) + 1), "1 kibi")
    )
    def test_what_is_not_a_size_is_refused(self, text):
        done = self.run_racebeam("config", "--max-memory=" + text)
        assert (done.returncode, done.stdout) == (2, b"")
        accepted = "is not a size; accepted: bytes, or 512M, 2G and the like, up to 1152921504606846976 "
        assert f"--max-memory: '{text}' {accepted}" in done.stderr.decode()

    @pytest.mark.parametrize(
        "option, least, most",
        (
            ("--max-states", 1, (1 << 31) - 1),
            ("--seed", 0, (1 << 32) - 1),
            ("--frame-skip", 1, (1 << 31) - 1),
            ("--threads", 1, 1024),
            ("--until-idle", 0, (1 << 31) - 1),
        ),
    )
    def test_a_whole_number_reaches_from_its_least_to_its_most(self, option, least, most):
        key = option[2:].replace("-", "_")
        for number in (least, most):
            assert self.settings(option, str(number))[key] == (str(number), "command line")
        for text in (str(least - 1), str(most + 1), "-0", "+1", "1.0", "0x1", ""):
            done = self.run_racebeam("config", f"{option}={text}")
            assert (done.returncode, done.stdout) == (2, b""), text

    def test_options_of_the_machine_are_settings(self):
        words = ("--frame-skip", "5", "--color-averaging", "--cpu", "interpreter", "--left", "paddles", "--mode", "0")
        words += ("--difficulty", "0", "--rules", "fixed", "--max-frames", "7", "--full-screen")
        found = {key: value for key, (value, source) in self.settings(*words).items() if source == "command line"}
        assert found == {
            "frame_skip": "5",
            "color_averaging": "true",
            "cpu": '"interpreter"',
            "left": '"paddles"',
            "mode": "0",
            "difficulty": "0",
            "rules": '"fixed"',
            "max_frames": "7",
            "full_screen": "true",
        }

    def test_options_win_over_variables_over_the_file_over_defaults(self):
        path = self.file("max_states = 1\nmax_machines = 2\nmax_sessions = 3\n")
        found = self.settings("--config", path, "--max-states", "9", RACEBEAM_MAX_STATES="8", RACEBEAM_MAX_MACHINES="7")
        assert found["max_states"] == ("9", "command line")
        assert found["max_machines"] == ("7", "environment")
        assert found["max_sessions"] == ("3", "file")
        assert found["grace"] == ("5", "default")

    def test_the_file_may_be_named_by_a_variable(self):
        path = self.file("grace = 77\n")
        assert self.settings(RACEBEAM_CONFIG=path)["grace"] == ("77", "file")

    def test_lists_and_flags(self):
        path = self.file('listen = ["unix:a", "unix:b"]\nclassic = true\n')
        found = self.settings("--config", path)
        assert (found["listen"][0], found["classic"][0]) == ('["unix:a", "unix:b"]', "true")
        found = self.settings("--config", path, RACEBEAM_LISTEN="unix:c  unix:d", RACEBEAM_CLASSIC="0")
        assert found["listen"] == ('["unix:c", "unix:d"]', "environment")
        assert found["classic"][1] == "environment"

    def test_what_it_prints_can_be_read_again(self):
        words = ("--listen", "tcp://127.0.0.1:0", "--rom", 'a "quoted" \\ name', "--sticky", "0.5", "--classic")
        output = self.run_racebeam("config", *words).stdout.decode()
        again = self.settings("--config", self.file(output))
        for key, (value, _) in self.settings(*words).items():
            assert again[key][0] == value, key

    @pytest.mark.parametrize(
        "option, value",
        (
            ("--sticky", ".5"),
            ("--sticky", "1."),
            ("--sticky", "0.123456789012"),
            ("--sticky", "1e-5"),
            ("--rom", "1e5"),
            ("--rom", ".5"),
            ("--rom", "-0"),
            ("--rom", "007"),
            ("--rom", "nan"),
            ("--rom", "1" * 30),
            ("--rom", "1.50"),
            ("--rom", "two\nlines\t"),
            ("--rom", "\x9b1m L\u00f6we"),
            ("--rom", "true"),
            ("--record-limit", str(1 << 60)),
        ),
    )
    def test_numbers_and_texts_that_look_like_them_are_kept_as_they_are(self, option, value):
        key = option[2:].replace("-", "_")
        output = self.run_racebeam("config", option, value).stdout.decode()
        again = self.run_racebeam("config", "--config", self.file(output)).stdout.decode()
        line = next(line for line in output.splitlines() if line.startswith(key + " "))
        assert line.replace("# command line", "# file") in again.splitlines()

    def test_the_server_obeys(self):
        path = self.file("max_states = 5\nstdio = true\n")
        done = self.run_racebeam("serve", "--config", path, data=b"hello\n", RACEBEAM_MAX_LINE="999")
        assert b" max_line=999 " in done.stdout
        assert b" max_states=5 " in done.stdout

    def test_a_file_may_have_settings_that_the_protocol_of_the_server_does_not_use(self):
        path = self.file("seed = 5\nfull_screen = true\nrecord_dir = 'nowhere'\n")
        done = self.run_racebeam(
            "serve", "--classic", "--stdio", "--rom", "builtin:beamfall", "--config", path, data=b"0,0,0,0\n"
        )
        assert (done.returncode, done.stdout) == (0, b"160-210\n\nDIE\n"), done.stderr
        path = self.file("seed = 5\nfull_screen = true\n")
        done = self.run_racebeam("serve", "--stdio", "--config", path, data=b"hello\n")
        assert (done.returncode, done.stdout[:10]) == (0, b"ok server="), done.stderr

    def refuse(self, text, *hints, **variables):
        done = self.run_racebeam("serve", "--stdio", *(["--config", self.file(text)] if text else []), **variables)
        assert (done.returncode, done.stdout, done.stderr.count(b"\n")) == (2, b"", 1), done.stderr
        for hint in hints:
            assert hint in done.stderr

    def test_invalid_settings_are_refused_and_named(self):
        self.refuse("max_state = 5\n", b"unknown setting 'max_state'; did you mean max_states", b"max_states, ")
        self.refuse("max-states = 5\n", b"unknown setting 'max-states'; did you mean max_states")
        self.refuse("colour = 5\n", b"unknown setting 'colour'; accepted: ")
        self.refuse("max_states = 0\n", b"settings.toml: max_states", b"'0' is not a whole number from 1")
        self.refuse("max_states = [1, 2]\n", b"max_states", b"must be one value")
        self.refuse("[limits]\nmax_states = 1\n", b"unknown setting 'limits'")
        self.refuse("max_states = \n", b"settings.toml", b"line 1")
        self.refuse("classic = 'perhaps'\n", b"must be true or false, not 'perhaps'")
        self.refuse("listen = ['nowhere']\n", b"listen", b"'nowhere' is not an address")
        self.refuse("game = 'pong'\n", b"--game-file: excludes --game", RACEBEAM_GAME_FILE="mine.toml")
        self.refuse("", b"RACEBEAM_GRACE", b"'soon' is not a whole number", RACEBEAM_GRACE="soon")
        self.refuse("", b"this is a directory, not a file", RACEBEAM_CONFIG=self.folder)
        self.refuse("", b"nothing.toml", RACEBEAM_CONFIG="nothing.toml")
