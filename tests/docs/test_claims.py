"""Tests claims of the documents: on the program's words, its settings, and how it ends."""

import os
import pathlib
import re
import socket
import subprocess
import sys
import tempfile
import unittest

import tomllib
from test_numbers import page, table
from tree import ROOT

sys.path.insert(0, str(ROOT / "tests/server"))
from harness import Server  # noqa: E402

BINARY = os.environ.get("RACEBEAM_BINARY", str(ROOT / "build/release/racebeam"))


def run(*words, data=""):
    return subprocess.run([BINARY, *words], input=data, capture_output=True, text=True)


def talk(*requests):
    """The replies of a session, each as its words."""
    return [line.split() for line in run("serve", "--stdio", data="\n".join(requests) + "\n").stdout.splitlines()]


def values(words):
    return dict(word.split("=", 1) for word in words if "=" in word)


class Program(unittest.TestCase):
    def subcommands(self):
        names = re.findall(r"^\| `racebeam (\w+)", page("README.md"), re.MULTILINE)
        self.assertEqual(len(names), 17)
        return names

    def test_a_usage_error_has_status_2_except_that_of_classic(self):
        for name in self.subcommands():
            with self.subTest(subcommand=name):
                done = run(name, "--no-such-option")
                self.assertEqual(done.returncode, 1 if name == "classic" else 2, done.stderr)
                self.assertRegex(done.stderr, r"^racebeam: .*--no-such-option.*\n$")

    def test_the_readme_lists_the_subcommands_of_the_program(self):
        accepted = re.search(r"accepted: (.*) \(see", run("moon").stderr)[1]
        self.assertEqual(sorted(accepted.split(", ")), sorted(self.subcommands()))

    def test_the_server_has_one_pair_of_pipes_for_each_address(self):
        done = run("serve", "--pipes", "a", "--pipes", "b")
        self.assertEqual((done.returncode, done.stdout), (2, ""))


class Protocol(unittest.TestCase):
    def test_frame_begins_at_power_on_which_a_seed_causes(self):
        replies = talk(
            "load beamfall seed=1 sticky=0",
            "observe frame episode_frame",
            "act 0*10",
            "reset",
            "act 0*5",
            "reset seed=3",
            "act 0*4",
        )
        frames = [(found["frame"], found["episode_frame"]) for found in map(values, replies) if "frame" in found]
        self.assertEqual(frames, [("10", "10"), ("10", "0"), ("15", "5"), ("0", "0"), ("4", "4")])

    def test_an_idle_classic_client_is_closed_without_die(self):
        command = ["serve", "--classic", "--rom", "builtin:beamfall", "--listen", "tcp://127.0.0.1:0", "--idle", "1"]
        with Server(*command) as server:
            with socket.create_connection(("127.0.0.1", server.port())) as client, client.makefile("rb") as lines:
                client.sendall(b"0,0,0,1\n")
                self.assertEqual(lines.read(), b"160-210\n0,0:\n")


class Presets(unittest.TestCase):
    def test_the_python_page_has_the_presets_of_the_protocol(self):
        rows = {name.strip("`"): row for name, *row in table(page("docs/python/reference.md"), "| preset | frames |")}
        self.assertEqual(set(rows), set(values(talk("hello")[0])["presets"].split(",")))
        for name, (frames, sticky, actions, limit, *besides) in rows.items():
            with self.subTest(preset=name):
                loaded = values(talk(f"load beamfall preset={name}")[0])
                self.assertEqual([loaded["frame_skip"], loaded["sticky"]], [frames, sticky])
                self.assertEqual(loaded["action_set"], {"all": "full"}.get(actions, actions))
                self.assertEqual(loaded["max_episode_frames"], limit.replace(",", ""))
                others = [loaded["life_loss"], loaded["noop_max"], loaded["reward_min"], loaded["reward_max"]]
                self.assertEqual(
                    others, ["restart", "30", "-1", "1"] if any(besides) else ["ignored", "0", "none", "none"]
                )

    def test_the_page_on_experiments_has_the_presets_of_plans(self):
        rows = table(page("docs/experiments.md"), "| Preset | Frames of a decision |")
        listed = {
            preset["name"]: preset["sets"]
            for preset in tomllib.loads(page("protocol/protocol.toml"))["evaluation_preset"]
        }
        self.assertEqual([name.strip("`") for name, *_ in rows], list(listed))
        for name, frames, sticky, actions, noops, longest, *_ in rows:
            words = f"frame_skip={frames} sticky={sticky} action_set={actions} max_episode_frames={longest}"
            self.assertEqual(listed[name.strip("`")], words.replace(",", "") + f" noop_max={noops}")

    def test_random_and_perturb_decide_on_every_frame_and_other_agents_as_the_preset_says(self):
        with tempfile.TemporaryDirectory() as folder:
            plan = pathlib.Path(folder, "plan.toml")
            plan.write_text(
                'games = ["beamfall"]\nagents = ["random", "perturb", "const", "basic"]\nenvironment = '
                '"max_episode_frames=100"\nevaluation_episodes = 1\ntrials = 1\ntraining_episodes = 0\n'
            )
            output = run("experiment", str(plan), "--dry-run", "--unmeasured").stdout
        decisions = dict(re.findall(r"^(\w+) +1?\d units +(\d+) decisions", output, re.MULTILINE))
        self.assertEqual(decisions, {"random": "100", "perturb": "1800", "const": "360", "basic": "20"})


class Lists(unittest.TestCase):
    def test_the_page_on_fuzzing_has_each_target(self):
        listed = re.findall(r"^\| `(\w+)` \|", page("fuzz/README.md"), re.MULTILINE)
        built = re.findall(r"^fuzz_target\((\w+) ", page("fuzz/CMakeLists.txt"), re.MULTILINE)
        run_by_script = re.findall(r'^    "(\w+)": \d+,$', page("scripts/fuzz"), re.MULTILINE)
        self.assertEqual(sorted(set(listed)), sorted(built))
        self.assertEqual(sorted(run_by_script), sorted(built))

    def test_each_generator_of_the_architecture_draws_by_its_seed(self):
        rows = table(page("docs/architecture.md"), "| generator | seeded with |")
        self.assertEqual([row[1] for row in rows], ["`--system-seed`", "`--seed`", "`--seed`"])

    def test_hooks_call_what_is_in_the_tree(self):
        entries = re.findall(r"entry: (\S+)(?: -B)? ?(\S*)", page(".pre-commit-config.yaml"))
        for program, script in entries:
            name = script if program == "python3" else program
            if "/" in name:
                self.assertTrue((ROOT / name).is_file(), name)

    def test_every_client_of_the_line_protocol_reads_the_address_of_its_environment(self):
        for folder in ("python/racebeam", "java/src/main", "lua/racebeam", "cpp/racebeam", "js/src", "shell"):
            files = [path for path in (ROOT / "clients" / folder).rglob("*") if path.is_file()]
            self.assertTrue(any(b"RACEBEAM_ADDRESS" in path.read_bytes() for path in files), folder)


if __name__ == "__main__":
    unittest.main()
