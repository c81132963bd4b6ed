"""Tests claims of the documents: on the program's words, its settings, and how it ends.

test_claims.toml has each sentence of some pages with all, every, only, always or never, and what holds it.
"""

import os
import pathlib
import re
import socket
import subprocess
import tempfile

import pytest
import tomllib
from harness import Server
from markdown import prose
from test_numbers import page, table
from tree import ROOT

UNIVERSAL = re.compile(r"\b(all|every|only|always|never)\b", re.IGNORECASE)
BINARY = os.environ.get("RACEBEAM_BINARY", str(ROOT / "build/release/racebeam"))


def run(*words, data=""):
    return subprocess.run([BINARY, *words], input=data, capture_output=True, text=True)


def talk(*requests):
    """The replies of a session, each as its words."""
    return [line.split() for line in run("serve", "--stdio", data="\n".join(requests) + "\n").stdout.splitlines()]


def values(words):
    return dict(word.split("=", 1) for word in words if "=" in word)


def universal_sentences(text):
    """The sentences of a page with a word such as every, without code, tables and headings."""
    blocks = [[]]
    for _, line in prose(text):
        if not line.strip() or line.startswith(("#", "|")) or re.match(r"\s*([*-]|\d+\.) ", line):
            blocks.append([])
        if not line.startswith(("#", "|")):
            blocks[-1].append(line.strip())
    for block in blocks:
        for sentence in re.split(r"(?<=[.:;])\s+(?=[A-Z`*])", " ".join(block)):
            if UNIVERSAL.search(sentence):
                yield sentence


class TestLedger:
    @pytest.fixture(autouse=True)
    def set_up(self):
        self.claims = tomllib.loads(page("tests/docs/test_claims.toml"))

    def test_each_universal_sentence_is_listed_with_what_holds_it(self, subtests):
        for name, listed in self.claims.items():
            for sentence in universal_sentences(page(name)):
                with subtests.test(page=name):
                    held = any(words in sentence for words in listed)
                    assert held, f"tests/docs/test_claims.toml lacks a sentence of {name}: {sentence}"

    def test_each_claim_is_in_its_page_and_what_holds_it_in_the_tree(self, subtests):
        for name, listed in self.claims.items():
            text = " ".join(page(name).split())
            for words, holder in listed.items():
                with subtests.test(page=name, claim=words):
                    assert words in text, "the page lacks these words"
                    file, _, test = holder.partition(": ")
                    if file != "says":
                        assert test in page(file), f"{file} lacks the test"


class TestWalks:
    """The tables of HACKING.md that follow a request and a write through the files."""

    def rows(self):
        """The names and the files of each row. A file's folder may be left out, as that of the one before it."""
        for heading in ("| Step | File |", "| Step | Function | File |"):
            for step, *functions, files in table(page("HACKING.md"), heading):
                names = [name.split("::")[-1] for cell in functions for name in re.findall(r"`([\w:]+)`", cell)]
                yield step, names, self.paths(re.findall(r"`([\w./]+)`", files))

    def paths(self, files):
        folder = pathlib.PurePath()
        for file in files:
            places = (pathlib.PurePath(), folder, folder.parent)
            path = next((place / file for place in places if (ROOT / place / file).is_file()), None)
            assert path, f"{file} does not exist"
            folder = path.parent
            yield path

    def test_each_function_is_in_a_file_of_its_row(self, subtests):
        for step, names, paths in self.rows():
            text = "".join(page(path) for path in paths)
            for name in names:
                with subtests.test(step=step, name=name):
                    assert re.search(rf"\b{name}\b", text)

    def test_the_files_are_counted(self):
        text = page("HACKING.md")
        for heading in ("| Step | File |", "| Step | Function | File |"):
            after = text[text.index(heading) :]
            rows = table(text, heading)
            files = {path for row in rows for path in self.paths(re.findall(r"`([\w./]+)`", row[-1]))}
            assert f"These are {len(files)} files." in after.split("\n\n")[1].replace("\n", " "), len(files)


class TestProgram:
    def subcommands(self):
        names = re.findall(r"^\| `racebeam (\w+)", page("README.md"), re.MULTILINE)
        assert {"serve", "classic", "png"} <= set(names)
        return names

    def test_a_usage_error_has_status_2_except_that_of_classic(self, subtests):
        for name in self.subcommands():
            with subtests.test(subcommand=name):
                done = run(name, "--no-such-option")
                assert (done.returncode, done.stdout) == (1 if name == "classic" else 2, ""), done.stderr
                assert re.search(r"^racebeam: .*--no-such-option.*\n$", done.stderr)

    def test_the_readme_lists_the_subcommands_of_the_program(self):
        accepted = re.search(r"accepted: (.*) \(see", run("moon").stderr)[1]
        assert sorted(accepted.split(", ")) == sorted(self.subcommands())

    def test_the_server_has_one_pair_of_pipes_for_each_address(self):
        done = run("serve", "--pipes", "a", "--pipes", "b")
        assert (done.returncode, done.stdout) == (2, "")


class TestProtocol:
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
        assert frames == [("10", "10"), ("10", "0"), ("15", "5"), ("0", "0"), ("4", "4")]

    def test_an_idle_classic_client_is_closed_without_die(self):
        command = ["serve", "--classic", "--rom", "builtin:beamfall", "--listen", "tcp://127.0.0.1:0", "--idle", "1"]
        with Server(*command) as server:
            with socket.create_connection(("127.0.0.1", server.port())) as client, client.makefile("rb") as lines:
                client.sendall(b"0,0,0,1\n")
                assert lines.read() == b"160-210\n0,0:\n"

    def test_only_requests_for_frames_run_frames(self):
        idle = ["settings", "stats", "actions", "names", "modes", "save a", "export a", "drop a", "peek 0", "poke 9 00"]
        replies = talk("load beamfall seed=1", "act 0*7", "look frame", *idle, "look frame")
        assert [words[0] for words in replies] == ["ok"] * (4 + len(idle))
        assert (replies[2], replies[-1]) == (["ok", "frame=7"], ["ok", "frame=7"])

    def test_each_generator_draws_by_its_own_seed(self):
        """That of no-ops goes on where a restored state has that of sticky actions; docs/architecture.md lists both."""

        def played(*settings):
            load = f"load beamfall {' '.join(settings)} noop_max=100 sticky=0.5"
            acts = ["act " + "3 1 " * 20, "look state_hash"]
            reset = ["reset", "look episode_frame"]
            return talk(load, "save s generator=1", reset[1], *acts, "restore s", *acts, *reset, "restore s", *reset)

        first = played("seed=1")
        assert first == played("seed=1")
        assert first[2:] != played("seed=2")[2:]
        assert first[4] == first[7]  # the state has the generator of sticky actions
        assert first[9] != first[12]  # and lacks that of no-ops
        same = [played("seed=1", f"system_seed={seed}")[2:] for seed in (1, 2)]
        assert same[0][0] == same[1][0]  # the seed of the system decides no no-ops

    def test_a_state_is_refused_under_other_rules_where_they_differ(self):
        """tests/protocol/load/load_test.cpp has a game in which they differ; in Beamfall, they do not."""
        state = values(talk("load beamfall seed=1", "save a", "export a")[-1])["data"]
        assert talk("load beamfall rules=fixed", f"import b {state}", "restore b")[2][0] == "ok"


class TestPresets:
    def test_the_python_page_has_the_presets_of_the_protocol(self, subtests):
        rows = {name.strip("`"): row for name, *row in table(page("docs/python/reference.md"), "| preset | frames |")}
        assert set(rows) == set(values(talk("hello")[0])["presets"].split(","))
        for name, (frames, sticky, actions, limit, *besides) in rows.items():
            with subtests.test(preset=name):
                loaded = values(talk(f"load beamfall preset={name}")[0])
                assert [loaded["frame_skip"], loaded["sticky"]] == [frames, sticky]
                assert loaded["action_set"] == {"all": "full"}.get(actions, actions)
                assert loaded["max_episode_frames"] == limit.replace(",", "")
                others = [loaded["life_loss"], loaded["noop_max"], loaded["reward_min"], loaded["reward_max"]]
                assert others == (["restart", "30", "-1", "1"] if any(besides) else ["ignored", "0", "none", "none"])

    def test_the_page_on_experiments_has_the_presets_of_plans(self):
        rows = table(page("docs/experiments.md"), "| Preset | Frames of a decision |")
        listed = {
            preset["name"]: preset["sets"]
            for preset in tomllib.loads(page("protocol/protocol.toml"))["evaluation_preset"]
        }
        assert [name.strip("`") for name, *_ in rows] == list(listed)
        for name, frames, sticky, actions, noops, longest, *_ in rows:
            words = f"frame_skip={frames} sticky={sticky} action_set={actions} max_episode_frames={longest}"
            assert listed[name.strip("`")] == words.replace(",", "") + f" noop_max={noops}"

    def test_random_and_perturb_decide_on_every_frame_and_other_agents_as_the_preset_says(self):
        with tempfile.TemporaryDirectory() as folder:
            plan = pathlib.Path(folder, "plan.toml")
            plan.write_text(
                'games = ["beamfall"]\nagents = ["random", "perturb", "const", "basic"]\nenvironment = '
                '"max_episode_frames=100"\nevaluation_episodes = 1\ntrials = 1\ntraining_episodes = 0\n'
            )
            output = run("experiment", str(plan), "--dry-run", "--unmeasured").stdout
        decisions = dict(re.findall(r"^(\w+) +1?\d units +(\d+) decisions", output, re.MULTILINE))
        assert decisions == {"random": "100", "perturb": "1800", "const": "360", "basic": "20"}


def number(text):
    return float(text.replace(",", ""))


class TestAgents:
    """The page on experiments has the settings of agents, with defaults and accepted values."""

    PLAN = 'games = ["beamfall"]\nagents = [{}]\nevaluation_episodes = 1\nenvironment = "max_episode_frames=5"\n'
    COMMON = {"frame_skip", "trials", "training_episodes", "training_frames", "evaluation_episodes"}

    @pytest.fixture(autouse=True)
    def set_up(self, tmp_path):
        self.folder, self.plan = tmp_path, tmp_path / "plan.toml"
        self.defaults = {}
        for names, settings in table(page("docs/experiments.md"), "| Agent | Its own settings"):
            values = dict(re.findall(r"`(\w+)` ([\w.,]+?)(?:, |$)", settings))
            of_agent = {name: value if value.isalpha() else number(value) for name, value in values.items()}
            self.defaults |= {agent: of_agent for agent in re.findall(r"`(\w+)`", names)}

    def test_the_defaults_are_those_that_results_have(self):
        rows = table(page("docs/experiments.md"), "| Agent | What it is")
        agents = re.findall(r"`(\w+)`", "".join(names for names, _ in rows))
        self.plan.write_text(self.PLAN.format(", ".join(f'"{agent}"' for agent in agents)))
        run("experiment", str(self.plan), "--into", str(self.folder / "results"), "--shard", "1/100000")
        written = tomllib.loads((self.folder / "results/plan.toml").read_text())["agent"]
        own = {
            agent: {name: value for name, value in settings.items() if name not in self.COMMON}
            for agent, settings in written.items()
        }
        own["iw1"]["limit_branches"] = 0  # which a plan names only if it is 1, as the page says
        assert self.defaults == {agent: settings for agent, settings in own.items() if settings}

    def test_another_value_is_refused_with_those_that_are_accepted(self, subtests):
        agent_with = {name: agent for agent, settings in self.defaults.items() for name in settings}
        rows = table(page("docs/experiments.md"), "| Setting | Meaning |")
        accepted = {name: words for names, _, words in rows for name in re.findall(r"`(\w+)`", names)}
        assert set(accepted) == set(agent_with)
        for name, words in accepted.items():
            with subtests.test(setting=name):
                wrong = '"x"' if name == "reward_scale" else "-1"
                agent = agent_with[name]
                self.plan.write_text(self.PLAN.format(f"'{agent}'") + f"[agent.{agent}]\n{name} = {wrong}\n")
                sentence = run("experiment", str(self.plan), "--dry-run", "--unmeasured").stderr.split("; ")[-1].strip()
                if name == "reward_scale":
                    assert sentence == "accepted: " + " and ".join(words.replace("`", "").rsplit(", ", 1))
                else:
                    ends = re.search(r"from (\S+) to (\S+)$", sentence).groups()
                    assert [number(end) for end in re.split(" to | or ", words)] == [number(end) for end in ends]


class TestLists:
    def test_the_page_on_fuzzing_has_each_target(self):
        targets = page("fuzz/README.md").partition("## Attacks")[0]
        listed = re.findall(r"^\| `(\w+)` \|", targets, re.MULTILINE)
        built = re.findall(r"^fuzz_target\((\w+) ", page("fuzz/CMakeLists.txt"), re.MULTILINE)
        run_by_script = re.findall(r'^    "(\w+)": \d+,$', page("scripts/fuzz"), re.MULTILINE)
        assert sorted(set(listed)) == sorted(built)
        assert sorted(run_by_script) == sorted(built)
        named = re.search(r"Fuzz targets cover (.*?) \(\[", " ".join(page("SECURITY.md").split()))[1]
        subjects = {
            "both protocols": "line_session classic_session",
            "RL-Glue": "rl_glue",
            "HTTP": "http",
            "WebSocket": "web_socket",
            "the records of TLS": "tls",
            "addresses, origins and tokens": "access",
            "images": "image",
            "saved states": "state",
            "game files": "game_file",
            "the configuration": "config",
            "plans, logs and submissions of experiments": "plan episode_log submission",
            "their checkpoints and backgrounds": "checkpoint background_csv",
            "announce files": "announce",
            "and encodings": "encodings",
        }
        assert named == ", ".join(subjects)
        assert set(built) - set(" ".join(subjects.values()).split()) == {"media"}  # made here

    def test_the_architecture_lists_three_generators_with_their_seeds(self):
        rows = table(page("docs/architecture.md"), "| generator | seeded with |")
        assert [row[1] for row in rows] == ["`--system-seed`", "`--seed`", "`--seed`"]

    def test_the_service_of_systemd_is_sandboxed_as_its_page_says(self):
        lines = page("packages/systemd/racebeam.service.in").splitlines()
        claim = "writes only to `/var/lib/racebeam` and to a private `/tmp`, and has no capabilities"
        assert claim in " ".join(page("packages/README.md").split())
        fences = {"ProtectHome=yes", "ProtectSystem=strict", "StateDirectory=racebeam", "PrivateTmp=yes"}
        assert (fences | {"CapabilityBoundingSet="}) - set(lines) == set()
        assert [line for line in lines if line.startswith(("ReadWritePaths", "BindPaths"))] == []

    def test_each_error_of_the_python_page_is_one_that_a_test_expects(self):
        tests = "".join(path.read_text() for path in (ROOT / "tests/python").rglob("*.*") if path.suffix != ".pyc")
        rows = table(page("docs/python/reference.md"), "| error | when |")
        names = {name for row in rows for name in re.findall(r"`[\w.]*?(\w+)`", " ".join(row))} - {"render"}
        assert len(names) > 12
        forms = r"(?:[Rr]aises(?:Regex)?\(.*|except .*|    |socket\.|\")"  # of a test, or of sentences.txt
        expected = {name for name in names if re.search(rf"{forms}{name}\b", tests)}
        assert names - expected - {"AtariEnv", "AtariVectorEnv", "render_mode"} == set()

    def test_hooks_call_what_is_in_the_tree(self):
        entries = re.findall(r"entry: (\S+) ?(\S*)", page(".pre-commit-config.yaml"))
        for program, script in entries:
            name = script if program == ".venv/bin/pytest" else program
            if "/" in name:
                assert (ROOT / name).is_file(), name

    def test_every_client_of_the_line_protocol_reads_the_address_of_its_environment(self):
        for folder in ("python/racebeam", "java/src/main", "lua/racebeam", "cpp/racebeam", "js/src", "shell"):
            files = [path for path in (ROOT / "clients" / folder).rglob("*") if path.is_file()]
            assert any(b"RACEBEAM_ADDRESS" in path.read_bytes() for path in files), folder
