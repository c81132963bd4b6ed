"""racebeam experiment and racebeam verify."""

import hashlib
import os
import pathlib
import random
import re
import resource
import signal
import subprocess
import time

import pytest
from harness import BINARY, PATIENCE
from terminal import Terminal

os.environ.pop("RACEBEAM_ROMS", None)

ROOT = pathlib.Path(__file__).resolve().parents[2]
LONGEST = 30 * PATIENCE  # seconds; an experiment of ten seconds may take this long on a busy machine

PLAN = """games = ["beamfall"]
agents = ["random", "const", "basic", "disco", "lsh", "uct"]
trials = 1
training_episodes = 8
evaluation_episodes = 3
background_screens = 500
class_screens = 500
environment = "max_episode_frames=1500"
[agent.uct]
trials = 2
simulations = 5
"""


def run(*words, **options):
    """Status, output and errors of racebeam, as text."""
    done = subprocess.run([BINARY, *words], capture_output=True, text=True, timeout=LONGEST, **options)
    return done.returncode, done.stdout, done.stderr


def files(folder):
    """The contents of all files of results by their paths, without times."""
    return {
        path.relative_to(folder).as_posix(): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file() and "times" not in path.name
    }


class TestExperiment:
    @pytest.fixture(autouse=True)
    def set_up(self, tmp_path):
        self.place = tmp_path
        self.plan = self.place / "plan.toml"
        self.plan.write_text(PLAN)

    def experiment(self, into, *words, **options):
        return run("experiment", str(self.plan), "--into", str(self.place / into), *words, **options)

    def test_a_line_a_unit_and_all_rows_confirmed(self):
        status, printed, errors = self.experiment("results")
        assert (status, errors) == (0, "")
        assert len(printed.splitlines()) == 1 + 18 + 3 + 2
        assert re.search(r"(?m)^\d+/24 beamfall-basic-1: 3 episodes, mean score [0-9.]+$", printed)
        status, printed, errors = run("verify", str(self.place / "results"))
        assert (status, errors) == (0, "")
        assert re.search(r"^68 rows confirmed, 0 wrong, 0 could not be checked; \d+ frames in ", printed)
        left = "nothing is left to run: other commands have finished these units, or are running them\n"
        assert self.experiment("results") == (0, left, "")

    def test_killed_at_any_moment_the_end_is_the_same(self):
        assert self.experiment("whole", "--threads", "1")[0] == 0
        chance = random.Random(5)
        kills = 0
        command = [
            BINARY,
            "experiment",
            str(self.plan),
            "--into",
            str(self.place / "parts"),
            "--threads",
            "2",
            "--checkpoint-seconds",
            "0",
        ]
        for _ in range(20):
            process = subprocess.Popen(command, stdout=subprocess.DEVNULL)
            time.sleep(chance.uniform(0.01, 0.25))
            process.send_signal(signal.SIGKILL)
            kills += process.wait() == -signal.SIGKILL
        assert kills > 0
        assert self.experiment("parts", "--cpu", "interpreter", env=os.environ | {"RACEBEAM_SIMD": "plain"})[0] == 0
        assert files(self.place / "parts") == files(self.place / "whole")

    def test_a_signal_ends_it_with_a_sentence_and_all_that_is_finished_is_in_the_tables(self):
        self.plan.write_text(PLAN.replace("training_episodes = 8", "training_episodes = 80000"))
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            into = self.place / number.name
            process = subprocess.Popen(
                [BINARY, "experiment", str(self.plan), "--into", str(into), "--threads", "1"],
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                text=True,
            )
            for _ in range(19):  # all of the baselines
                process.stdout.readline()
            process.send_signal(number)
            _, errors = process.communicate(timeout=PATIENCE)
            assert (process.returncode, errors) == (
                -number,
                "racebeam: a signal ended the experiment; the same command continues it\n",
            )
            assert (into / "results.csv").read_text().count("\n") == 1 + 19 * 3

    def test_a_terminal_shows_progress_within_a_unit(self, cleanup):
        self.plan.write_text('games = ["beamfall"]\nagents = ["uct"]\n[agent.uct]\ntrials = 1\nsimulations = 60\n')
        terminal = Terminal([BINARY, "experiment", str(self.plan), "--into", str(self.place / "results")])
        cleanup(terminal.close)
        terminal.wait_until(
            lambda: re.match(r"0/1 beamfall-uct-1: 0 episodes and [1-9]\d* decisions, \d+ min left", terminal.line(0)),
            "progress",
        )

    def test_altered_results_are_named(self):
        self.experiment("results")
        table = self.place / "results" / "results.csv"
        lines = table.read_text().splitlines(keepends=True)
        fields = lines[1].split(",")
        fields[8] = str(int(fields[8]) + 1)
        table.write_text("".join([lines[0], ",".join(fields), *lines[2:]]))
        status, printed, _ = run("verify", str(self.place / "results"))
        assert status == 1
        assert re.search(
            r"results.csv:2 \(beamfall-random-1, episode 1\): not confirmed: score is '\d+'; its log has", printed
        )

    def test_tables_say_what_they_were_made_from(self):
        self.experiment("results")
        report = self.place / "report.md"
        report.write_text("made from results.csv sha256:0000")
        status, printed, _ = run("verify", str(self.place / "results"), "--table", str(report))
        assert status == 1
        assert "was not made from these results: it lacks their digest, " in printed
        digest = subprocess.run(
            ["sha256sum", str(self.place / "results" / "results.csv")], capture_output=True, text=True
        )
        report.write_text("made from results.csv sha256:" + digest.stdout.split()[0])
        status, printed, _ = run("verify", str(self.place / "results"), "--table", str(report))
        assert status == 0, printed
        assert "report.md says that it was made from these results\n" in printed
        curves = hashlib.sha256((self.place / "results" / "curves.csv").read_bytes()).hexdigest()
        report.write_text("made from curves.csv sha256:" + curves)
        status, printed, _ = run("verify", str(self.place / "results"), "--table", str(report))
        assert status == 0, printed
        assert "report.md says that it was made from the curves.csv of these results\n" in printed

    def test_a_disk_that_is_full_loses_nothing_that_is_finished(self):
        assert self.experiment("whole")[0] == 0

        def few_bytes():
            signal.signal(signal.SIGXFSZ, signal.SIG_DFL)  # Python ignores it
            resource.setrlimit(resource.RLIMIT_FSIZE, (1200, 1200))

        status, _, errors = self.experiment("parts", preexec_fn=few_bytes)
        assert status == 1
        assert re.search(r"^racebeam: cannot write .*: File too large\n$", errors)
        assert self.experiment("parts")[0] == 0
        assert files(self.place / "parts") == files(self.place / "whole")

    def test_bad_input_is_named_and_nothing_is_written(self):
        for words, status, sentence in (
            (["no"], 1, "unknown plan 'no'; accepted: paper, hour, smoke, baselines, "),
            (["./none.toml"], 1, "plan ./none.toml: no such file"),
            (["paper"], 1, "no image was found for: asterix, beam_rider, freeway, seaquest, space_invaders, alien, "),
            *(
                (
                    ["smoke", "--shard", shard, *more],
                    2,
                    f"--shard: '{shard}' is not a shard; accepted is K/N, with K from 1 to N",
                )
                for shard in ("3/2", "0/2", "x", "")
                for more in ([], ["--dry-run"])
            ),
            *(
                (["smoke", "--threads", count], 2, f"--threads: '{count}' is not a whole number from 0 to 1024")
                for count in ("-1", "1025")
            ),
        ):
            found = run("experiment", *words, "--into", str(self.place / "bad"))
            assert found[0] == status, found
            assert found[2].startswith("racebeam: " + sentence), found[2]
            assert not (self.place / "bad").exists()
        assert run("experiment", "smoke")[0] == 2

    def test_threads_are_as_many_as_are_asked_for_and_else_one_for_each_processor(self):
        plan = 'games = ["beamfall"]\nagents = ["disco"]\n[agent.disco]\ntrials = 2000\ntilings = 64\ngrid = 64\n'
        self.plan.write_text(plan)  # no machine has the memory

        def threads(*words):
            status, printed, errors = self.experiment("results", *words)
            assert (status, printed) == (1, "")
            return int(re.search(r" MB for disco on each of (\d+) threads; ", errors)[1])

        for count in (1, 3, 1024):
            assert threads("--threads", str(count)) == count
        assert threads("--threads", "0") == threads()
        assert 1 <= threads() <= len(os.sched_getaffinity(0))  # a quota may allow fewer
        assert not (self.place / "results").exists()

    def test_verify_says_what_a_folder_lacks(self):
        (self.place / "empty").mkdir()
        (self.place / "file").touch()
        takes = "verify takes a folder, or a log whose name ends with .episode"
        for name, sentence in (
            ("none", f"no such folder; {takes}"),
            ("file", f"this is not a folder; {takes}"),
            ("empty", "it has neither plan.toml, as of an experiment, nor agent.toml, as of a submission"),
        ):
            path = self.place / name
            assert run("verify", str(path)) == (1, "", f"racebeam: results {path}: {sentence}\n")

    def test_the_evaluation_knows_all_agents(self):
        self.plan.write_text('games = ["beamfall"]\nagents = ["none"]\n')
        status, _, errors = self.experiment("results")
        assert status == 1
        agents = re.search(r"unknown agent 'none'; accepted: (.*)\n", errors)[1].split(", ")
        scores = (ROOT / "evaluation/racebeam_evaluation/scores.py").read_text()
        names = [
            name
            for group in ("BASELINE_VIEWS", "_LEARNERS", "_PLANNERS")
            for name in re.findall(r'"(\w+)"', re.search(rf"(?m)^{group} = \((.*?)\)", scores)[1])
        ]
        assert sorted(agents) == sorted(names)

    def test_verification_takes_no_memory_for_the_rows(self):
        self.plan.write_text('games = ["beamfall"]\nagents = ["random"]\nevaluation_episodes = 2\n')
        assert self.experiment("results")[0] == 0
        folder = self.place / "results"
        rows = (folder / "results.csv").read_text().splitlines(keepends=True)
        with (folder / "results.csv").open("w") as table:
            table.writelines(rows)
            for _ in range(300):
                table.write(rows[1] * 1000)

        def limit():
            resource.setrlimit(resource.RLIMIT_AS, (512 << 20, 512 << 20))

        with (self.place / "printed").open("w+") as printed:
            done = subprocess.run(
                [BINARY, "verify", str(folder), "--threads", "1"],
                stdout=printed,
                stderr=subprocess.PIPE,
                preexec_fn=limit,
                text=True,
                timeout=LONGEST,
            )
            printed.seek(0)
            last = printed.readlines()[-1]
        assert (done.returncode, done.stderr) == (1, "")
        assert re.search("^2 rows confirmed, 300000 wrong, 0 could not be checked; ", last)

    def test_too_little_memory_is_a_sentence(self):
        plan = 'games = "paper"\nagents = ["const"]\ntrials = 1\nevaluation_episodes = 1\n'
        self.plan.write_text(plan)
        errors = set()
        for size in range(16, 80, 4):

            def limit():
                return resource.setrlimit(resource.RLIMIT_AS, (size << 20, size << 20))  # noqa: B023

            status, _, error = run("experiment", str(self.plan), "--dry-run", preexec_fn=limit)
            if status == 1:
                errors.add(error)
        assert "racebeam: std::bad_alloc\n" not in errors

    def test_one_log_is_verified_too(self):
        self.plan.write_text('games = ["beamfall"]\nagents = ["random"]\nevaluation_episodes = 2\n')
        assert self.experiment("results")[0] == 0
        logs = self.place / "results/logs/beamfall-random-1"
        status, printed, errors = run("verify", str(logs / "1.episode"))
        assert (status, errors) == (0, "")
        assert re.search(r"^1\.episode \(beamfall, random, score \d+\): confirmed; \d+ frames in [0-9.]+ s\n$", printed)
        (self.place / "cut.episode").write_bytes((logs / "1.episode").read_bytes()[:-1])
        status, printed, errors = run("verify", str(self.place / "cut.episode"))
        assert (status, printed) == (1, "")
        assert errors == "racebeam: episode log cut.episode: its checksum is wrong; it was cut or altered\n"
        status, _, errors = run("verify", str(logs / "1.episode"), "--table", str(self.plan))
        assert (status, errors) == (
            2,
            "racebeam: --table needs the folder of the results, and this is one log (see racebeam verify --help)\n",
        )

    def test_the_results_in_the_tree_are_confirmed(self):
        folders = [plan.parent for plan in sorted((ROOT / "docs/results").glob("*/plan.toml"))]
        assert ROOT / "docs/results/own-games" in folders
        kept = sum(path.stat().st_size for path in (ROOT / "docs/results").rglob("*") if path.is_file())
        assert kept < 6 << 20  # which a clone carries: logs of 990 units of Perturb and 60 of learners
        for folder in folders:
            status, printed, _ = run("verify", str(folder))
            assert status == (0 if folder.name == "own-games" else 2), printed  # 2: the image is not here
            assert " rows confirmed, 0 wrong, " in printed

    def test_a_dry_run_lists_cost_and_missing_images(self):
        status, printed, _ = run("experiment", "paper", "--dry-run")  # without images, nothing can be measured
        assert status == 0
        assert "missing image: zaxxon\n" in printed
        assert re.search(r"(?m)^basic +1650 units +\d+ decisions +[0-9.]+ core-hours$", printed)
        assert (
            "core-hours are an estimate: each episode is taken to last 18000 frames, as long as it may, and speeds are "
            "those of a table\n"
        ) in printed
        assert re.search(r"(?m)^memory: about \d+ MB, and \d+ MB a thread; disk: about \d+ MB; ", printed)
        units = re.findall(r"(?m)^unit (\S+)  [0-9.]+ core-hours$", printed)
        assert (len(units), units[0], units[-1]) == (11385, "asterix-random-1", "zaxxon-uct-10")
        _, part, _ = run("experiment", "paper", "--dry-run", "--shard", "3/1000")
        assert re.findall(r"(?m)^unit (\S+) ", part) == units[2::1000]

    @pytest.mark.slow
    def test_a_dry_run_says_how_long_a_plan_takes(self):
        for agents, more in (
            ('["random", "const", "perturb"]', "evaluation_episodes = 30\n"),
            ('["basic", "lsh"]', "trials = 1\ntraining_episodes = 10\nevaluation_episodes = 2\n"),
            ('["basic", "disco"]', "trials = 1\ntraining_frames = 100000\nevaluation_episodes = 1\n"),
        ):
            self.plan.write_text(f'games = ["beamfall", "updraft"]\nagents = {agents}\n{more}')
            status, printed, errors = run("experiment", str(self.plan), "--dry-run")
            assert (status, errors) == (0, "")
            assert "core-hours are from a moment of play on this machine, in 2 of 2 games; " in printed
            expected = 3600 * float(re.search(r"(?m)^all +\d+ units +\d+ decisions +([0-9.]+) core-hours$", printed)[1])
            before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
            assert self.experiment(f"results{len(agents)}", "--threads", "1")[0] == 0
            seconds = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
            assert 0.5 < expected / seconds < 2, (agents, expected, seconds)

    def test_units_are_played_again(self):
        self.plan.write_text('games = ["beamfall"]\nagents = ["random"]\nevaluation_episodes = 2\n')
        assert self.experiment("results")[0] == 0
        results = self.place / "results"
        status, printed, errors = run("verify", str(results), "--rerun", "1", "--rerun-seed", "7")
        assert (status, errors) == (0, "")
        assert "units are chosen by --rerun-seed 7\n" in printed
        assert "beamfall-random-1: played again, and all rows are the same\n" in printed
        assert "1 units played again: 1 the same, 0 not\n" in printed
        status, printed, errors = run("verify", str(results), "--rerun", "0")
        assert (status, errors) == (0, "")
        assert re.search(r"^2 rows confirmed, 0 wrong, 0 could not be checked; [^\n]*\n$", printed)
        table = (results / "results.csv").read_text()
        score = table.splitlines()[1].split(",")[8]
        (results / "results.csv").write_text(table.replace(f",{score},", f",{int(score) + 1},", 1))
        status, printed, _ = run("verify", str(results), "--rerun", "1")
        assert status == 1
        assert re.search(r"(?m)^units are chosen by --rerun-seed \d+$", printed)
        assert (
            f"beamfall-random-1: not the same: results.csv, episode 1: score is {int(score) + 1}; "
            f"played again, the agent has {score}\n"
        ) in printed
        status, _, errors = run("verify", str(results), "--rerun", "1", "--rerun-seed", "x")
        assert status == 2
        assert "--rerun-seed: seed is 'x'" in errors
        log = results / "logs/beamfall-random-1/1.episode"
        status, _, errors = run("verify", str(results), "--rerun-seed", "3")
        assert (status, errors) == (2, "racebeam: --rerun-seed needs --rerun (see racebeam verify --help)\n")
        status, _, errors = run("verify", str(log), "--rerun", "1")
        assert status == 2
        assert "--rerun needs the folder of the results, and this is one log" in errors

    def test_the_set_of_57_games_is_that_of_the_evaluation(self):
        self.plan.write_text('games = "atari57"\nagents = ["random"]\n')
        status, printed, _ = run("experiment", str(self.plan), "--dry-run")
        assert status == 0
        games = (ROOT / "evaluation/racebeam_evaluation/data/atari57.csv").read_text().splitlines()[1:]
        assert re.findall(r"(?m)^missing image: (\w+)$", printed) == [line.split(",")[0] for line in games]

    def test_an_experiment_takes_a_background_from_a_csv_file_that_its_plan_names(self):
        csv = self.place / "beamfall.csv"
        csv.write_text((",".join(["0"] * 160) + "\n") * 210)
        digest = hashlib.sha256(csv.read_bytes()).hexdigest()
        status, printed, errors = run(
            "background", "beamfall", "--csv", str(csv), "--into", str(self.place / "results" / "games")
        )
        assert (status, errors) == (0, "")
        line = f'beamfall = "{digest}"'
        assert f"a plan takes this background with [backgrounds] and {line}\n" in printed
        self.plan.write_text(
            PLAN.replace('"random", "const", "basic", "disco", "lsh", "uct"', '"basic"').partition("[agent")[0]
        )
        status, _, errors = self.experiment("results")
        assert status == 1
        assert re.search(f"results/games/beamfall.background: csv is '{digest[:40]}...'; expected none", errors)
        assert not (self.place / "results" / "plan.toml").exists()
        self.plan.write_text(self.plan.read_text() + f"[backgrounds]\n{line}\n")
        assert self.experiment("results")[::2] == (0, "")
        assert f"[backgrounds]\n{line}\n" in (self.place / "results" / "plan.toml").read_text()

    def test_classes_are_discovered_and_drawn_and_an_experiment_takes_them(self):
        games = self.place / "results" / "games"
        words = ("classes", "beamfall", "--screens", "500", "--background-screens", "500", "--into")
        status, printed, errors = run(*words, str(games))
        assert (status, errors) == (0, "")
        assert re.search(r"beamfall.classes and its pictures are written: [1-9]\d* classes of \d+ shapes\n$", printed)
        for name in ("classes", "objects"):
            assert (games / f"beamfall-{name}.png").read_bytes().startswith(b"\x89PNG")
        results = files(games)
        self.plan.write_text(
            PLAN.replace('"random", "const", "basic", "disco", "lsh", "uct"', '"disco"').partition("[agent")[0]
        )
        assert self.experiment("results")[0] == 0
        assert {name: contents for name, contents in files(games).items() if name in results} == results
        self.plan.write_text(self.plan.read_text().replace("class_screens = 500", "class_screens = 501"))
        (self.place / "other").mkdir()
        games.rename(self.place / "other" / "games")
        status, _, errors = self.experiment("other")
        assert status == 1
        assert re.search("other/games/beamfall.classes: screens is '500'; expected '501'", errors)
