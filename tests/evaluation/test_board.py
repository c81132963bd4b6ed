"""The board shows submissions, and refuses what does not fit in a sentence."""

import base64
import hashlib
import json
import os
import pathlib
import re
import resource
import shutil
import signal
import struct
import xml.etree.ElementTree
import zlib

import package
import pytest

package.require()

from made_results import evaluate
from made_submissions import ABOUT, SETTINGS, log, log_path, row_of, seal, submission, write_rows
from racebeam_evaluation import errors, main  # noqa: E402, F401
from racebeam_evaluation.board import site
from racebeam_evaluation.board.episode_log import read_log
from racebeam_evaluation.board.submission import read_submission, seed_of_phrase

OWN_GAMES = package.SOURCE / "docs/results/own-games"


def resident_bytes():
    """The memory of this process."""
    return int(pathlib.Path("/proc/self/statm").read_text().split()[1]) * resource.getpagesize()


class Folder:
    @pytest.fixture(autouse=True)
    def own_folder(self, tmp_path):
        self.root = tmp_path

    def board(self, *arguments):
        return evaluate("--board", *arguments, "--into", self.root / "site")

    def page(self, name="index.html"):
        return (self.root / "site" / name).read_text()


class TestBoard(Folder):
    def test_two_agents_are_compared(self):
        submission(self.root / "a", "mine", {"pong": [[-20, -10], [0, 10]], "boxing": [[5], [6]]})
        submission(self.root / "b", "yours", {"pong": [[20], [18]]})
        done = self.board(self.root / "a", self.root / "b")
        assert (done.returncode, done.stderr) == (0, "")
        index = self.page()
        # Pong: random play -20.7, people 14.6. The trials of yours have 20 and 18: (38 / 2 + 20.7) / 35.3.
        assert "1.125 (1.096 to 1.153)" in index
        assert index.index("yours 1.0") < index.index("mine 1.0")  # the higher IQM first
        assert '<td class="number"><a href="agent1.html#pong">-5.0</a></td>' in index
        assert '<td class="number"><a href="agent1.html#boxing">5.5</a></td><td class="number"></td>' in index
        assert "They were not played again" in index

    def test_every_link_leads_somewhere_and_logs_are_the_same_bytes(self):
        folder, rows = submission(self.root / "a")
        self.board(folder)
        site = self.root / "site"
        for page in site.glob("*.html"):
            for address in re.findall(r'(?:href|src)="([^"]*)"', page.read_text()):
                file, _, anchor = address.partition("#")
                if not file.startswith("https://"):
                    assert (site / file).is_file(), address
                if anchor:
                    assert f'id="{anchor}"' in (site / file).read_text()
        copies = {path.read_bytes() for path in site.rglob("*.episode")}
        assert copies == {log_path(folder, row).read_bytes() for row in rows}

    def test_words_are_not_markup(self):
        self.board(submission(self.root / "a")[0])
        for name in ("index.html", "agent1.html"):
            assert "Ours &lt;b&gt;&amp; theirs&lt;/b&gt;" in self.page(name)

    def test_a_link_of_the_viewer_has_the_episode(self):
        self.board(submission(self.root / "a")[0], "--viewer", "https://example.org/racebeam/")
        packed = re.search(
            r'href="https://example.org/racebeam/#replay=([\w-]+)&amp;frame=0"', self.page("agent1.html")
        )
        text = json.loads(zlib.decompress(base64.urlsafe_b64decode(packed[1] + "==")))
        assert (text["game"], text["acts"], text["settings"]["seed"]) == ("pong", ["3*300"], "7")

    def test_presets_are_not_mixed(self):
        submission(self.root / "a")
        folder, rows = submission(self.root / "b", "yours", preset="machado2018")
        for row in rows:
            log_path(folder, row).write_bytes(
                log(row, "frame_skip=5 sticky=0.25 action_set=full max_episode_frames=18000")
            )
            row["log_digest"] = hashlib.sha256(log_path(folder, row).read_bytes()).hexdigest()
        write_rows(folder, rows)
        done = self.board(self.root / "a", folder)
        assert (done.returncode, done.stderr) == (0, "")
        index = self.page()
        assert index.count("<h2>Preset") == 2
        assert "<th>mine 1.0</th><th>yours 1.0</th>" not in index

    def test_agents_without_a_human_score_are_last_and_have_no_number(self):
        submission(self.root / "a", "first", {"beamfall": [[5]]})
        submission(self.root / "b", "second", {"pong": [[-20]], "beamfall": [[6]]})
        submission(self.root / "c", "third", {"pong": [[20.25]]})
        assert self.board(self.root / "a", self.root / "b", self.root / "c").returncode == 0
        index = self.page()
        places = [index.index(f"{name} 1.0") for name in ("third", "second", "first")]
        assert places == sorted(places)
        number = '<td class="number">{}</td>'
        assert "".join(map(number.format, ("4,000,000", 0, *["n/a"] * 3))) in index
        # One trial has no interval: (-20 + 20.7) / 35.3.
        assert "".join(map(number.format, ("4,000,000", 1, *["0.020"] * 3))) in index
        assert "<th>game</th><th" in index
        assert '<td class="number"><a href="agent3.html#pong">20.2</a></td>' in index

    def test_200_letters_of_the_words_are_on_the_first_page(self):
        folder, _ = submission(self.root / "a")
        (folder / "agent.toml").write_text(
            ABOUT.format(agent="mine", preset="paper2013").replace("Ours <b>& theirs</b>", "x" * 4000)
        )
        assert self.board(folder).returncode == 0
        assert f">{'x' * 200}<" in self.page()
        assert f">{'x' * 4000}<" in self.page("agent1.html")

    def test_curves_are_shown(self):
        folder, _ = submission(self.root / "a")
        (folder / "curves.csv").write_text(
            "game,agent,trial,episode,score,frames\npong,mine,1,1,-20,1000\npong,mine,1,2,-10,1000\n"
        )
        self.board(folder)
        assert '<img src="curves-paper2013.svg"' in self.page()
        assert (self.root / "site/curves-paper2013.png").is_file()

    def test_curves_of_more_games_than_a_picture_has(self, monkeypatch):
        monkeypatch.setattr(site, "_MOST_CURVES", 2)
        folder, _ = submission(self.root / "a")
        games = ("seaquest", "pong", "boxing")
        rows = "".join(f"{game},mine,1,1,-20,1000\n" for game in games)
        (folder / "curves.csv").write_text(f"game,agent,trial,episode,score,frames\n{rows}")
        assert self.board(folder).returncode == 0
        assert "Of 3 games, the first 2 are shown." in self.page()
        picture = (self.root / "site/curves-paper2013.svg").read_text()
        assert [game for game in games if f"<!-- {game} -->" in picture] == ["seaquest", "boxing"]

    def test_a_name_is_not_a_formula_and_a_picture_is_xml(self):
        folder, _ = submission(self.root / "a")
        about = folder / "agent.toml"
        about.write_text(about.read_text().replace('"1.0"', r'"$\\frac{$ \u001b"'))
        (folder / "plan.toml").write_text("[images]\n'$^$' = 'aa'\n")
        (folder / "curves.csv").write_text("game,agent,trial,episode,score,frames\n$^$,mine,1,1,-20,1000\n")
        assert self.board(folder).returncode == 0
        picture = (self.root / "site/curves-paper2013.svg").read_text()
        xml.etree.ElementTree.fromstring(picture)
        assert r"<!-- mine $\frac{$ \x1b -->" in picture
        assert "<!-- $^$ -->" in picture

    def test_logs_of_racebeam_itself(self):
        folder = self.root / "basic"
        folder.mkdir()
        (folder / "agent.toml").write_text(ABOUT.format(agent="basic", preset="other"))
        lines = (OWN_GAMES / "results.csv").read_text().splitlines()
        selection = [line for line in lines if line.startswith("unit,") or ",basic," in line]
        (folder / "results.csv").write_text("\n".join([*selection, ""]))
        shutil.copytree(OWN_GAMES / "logs", folder / "logs")
        done = self.board(folder)
        assert (done.returncode, done.stderr) == (0, "")
        assert "beamfall" in self.page()

    def test_a_broken_folder_is_named_and_the_others_are_shown(self):
        good, _ = submission(self.root / "good")
        broken, rows = submission(self.root / "broken", "yours")
        log_path(broken, rows[1]).write_bytes(b"RBEPISOD")
        done = self.board(broken, good, self.root / "none")
        assert done.returncode == 3
        assert len(done.stderr.splitlines()) == 2
        assert "racebeam-evaluate: not shown: " in done.stderr
        index = self.page()
        assert "mine 1.0" in index
        assert "yours 1.0" not in index
        assert "2.episode is not an episode log" in index
        assert ">none/agent.toml cannot be read" in index
        assert str(self.root) not in index

    def test_a_full_disk_leaves_nothing(self):
        folder, _ = submission(self.root / "mine")
        limits = resource.getrlimit(resource.RLIMIT_FSIZE)
        ignored = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (500, limits[1]))  # a write beyond it fails, as on a full disk
        try:
            done = self.board(folder)
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, limits)
            signal.signal(signal.SIGXFSZ, ignored)
        assert done.returncode == 1
        assert re.search(
            "^racebeam-evaluate: .*/site cannot be written: File too large; expected a folder ", done.stderr
        )
        assert [path.name for path in self.root.iterdir()] == ["mine"]

    def test_one_version_of_an_agent_and_one_image_of_a_game(self):
        submission(self.root / "a")
        submission(self.root / "b")
        other, rows = submission(self.root / "c", "yours")
        rows = [row_of("yours", "pong", row["trial"], row["episode"], row["score"], image_md5="aa") for row in rows]
        for row in rows:
            log_path(other, row).write_bytes(log(row))
        write_rows(other, rows)
        done = self.board(self.root / "a", self.root / "b", other)
        assert done.returncode == 3
        assert "b is of mine 1.0, which is there; expected another version" in done.stderr
        assert "the image of pong is aa; expected md5-of-pong, as the others have" in done.stderr

    def test_another_image_of_a_trial_that_diverged(self):
        good, _ = submission(self.root / "a")
        other, rows = submission(self.root / "b", "yours", {"boxing": [[5]]})
        lost = row_of("yours", "pong", 9, 0, "", end="diverged", image_md5="aa")
        write_rows(other, [*rows, lost])
        done = self.board(good, other)
        assert done.returncode == 3
        assert "the image of pong is aa; expected md5-of-pong, as the others have" in done.stderr
        assert "mine 1.0" in self.page()


class TestBadInput(Folder):
    @pytest.fixture(autouse=True)
    def made_submission(self, own_folder):
        self.folder, self.rows = submission(self.root / "a")
        self.log = log_path(self.folder, self.rows[0])

    def check_refusal(self, sentence):
        """Checks that the folder is refused with `sentence`, and that nothing is written."""
        done = self.board(self.folder)
        assert (done.returncode, done.stdout) == (1, ""), done.stderr
        assert len(done.stderr.splitlines()) == 1, done.stderr
        assert sentence in done.stderr
        assert not (self.root / "site").exists()

    def test_a_log_that_is_cut_or_altered(self):
        whole = self.log.read_bytes()
        for size in (0, 10, 24, len(whole) - 1):
            self.log.write_bytes(whole[:size])
            self.check_refusal("1.episode ")
        for place in (0, 8, 13, 21, 30, len(whole) - 1):
            self.log.write_bytes(whole[:place] + bytes([whole[place] ^ 1]) + whole[place + 1 :])
            self.check_refusal("1.episode ")
        self.log.unlink()
        self.check_refusal("1.episode cannot be read: No such file or directory; expected an episode log")

    def test_a_log_of_a_gigabyte_is_not_read(self):
        with self.log.open("r+b") as file:
            file.truncate(2**30)
        before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        self.check_refusal("1.episode has 1073741824 bytes; expected an episode log of at most 2097152")
        assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 100_000  # KiB

    def contents(self, settings=SETTINGS):
        """Returns the bytes of the first log that its seal covers."""
        return zlib.decompress(log(self.rows[0], settings)[24:])

    def test_actions_are_not_kept(self):
        """A log of a few KiB may have two million actions, and a submission thousands of logs."""
        names = [f"{trial}" for trial in range(1, 31)]
        rows = [row_of("mine", "pong", trial, 1, 1, decisions="400000") for trial in names]
        for row in rows:
            path = log_path(self.folder, row)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(log(row, actions=bytes(400000) + struct.pack("<f", 0.5) * 400000))
            row["log_digest"] = hashlib.sha256(path.read_bytes()).hexdigest()
        write_rows(self.folder, rows)
        before = resident_bytes()
        kept = read_submission(self.folder)
        assert resident_bytes() - before < 100e6  # all actions with their strengths would take 400 MB
        assert len(kept.episodes) == len(rows)

    def test_the_size_of_the_contents_is_exact(self):
        for size in (len(self.contents()) - 1, len(self.contents()) + 1):
            self.log.write_bytes(seal(self.contents(), size=size))
            self.check_refusal(f"1.episode is damaged: its contents do not have {size} bytes")
        head = struct.pack("<8sIQ", b"RBEPISOD", 1, 0)
        self.log.write_bytes(head + struct.pack("<I", zlib.crc32(head)))  # nothing follows
        self.check_refusal("1.episode is damaged: its contents do not have 0 bytes")

    def test_contents_of_two_mebibytes_are_read_and_one_more_byte_is_not(self):
        room = 2**21 - len(self.contents(SETTINGS + " "))
        self.log.write_bytes(seal(self.contents(f"{SETTINGS} {'x' * room}")))
        assert read_log(self.log).actions == bytes([3] * 300)
        self.log.write_bytes(seal(self.contents(f"{SETTINGS} {'x' * (room + 1)}")))
        self.check_refusal("1.episode has contents of 2097153 bytes; expected at most 2097152")

    def test_a_hash_for_each_256_decisions(self):
        path = self.folder / "1.episode"
        for decisions in (0, 1, 255, 256, 257, 511, 512):
            row = {**self.rows[0], "decisions": str(decisions), "state_hash": "0123456789abcdef"}
            path.write_bytes(log(row, actions=bytes([17] * decisions)))
            read = read_log(path)
            assert (read.actions, read.strengths) == (bytes([17] * decisions), ())
            assert (read.columns["state_hash"], read.columns["decisions"]) == ("0123456789abcdef", str(decisions))

    def test_a_number_of_decisions_that_does_not_fit(self):
        whole = self.contents()
        for number in (b"", b"-1", b"x", b"299", b"301", b"9" * 5000, "\u0663\u0660\u0660".encode()):
            self.log.write_bytes(seal(whole.replace(b"decisions=300", b"decisions=" + number)))
            self.check_refusal(f"1.episode says decisions={number.decode()}, which does not fit its actions")

    def test_a_log_of_other_lines(self):
        whole = self.contents()
        load, image = whole.split(b"\n")[:2]
        for before, after in (
            (load, b"load"),
            (load, b"loads" + load[4:]),
            (image, b"image"),
            (image, image + b" more"),
            (image + b"\n", b""),
        ):
            self.log.write_bytes(seal(whole.replace(before, after)))
            self.check_refusal("its text has other lines; expected load, image, from, ended")
        self.log.write_bytes(seal(whole.replace(b"\n\n", b"\n")))
        self.check_refusal("its text does not end; expected a whole log")

    def test_actions_of_the_console_and_of_keyboards(self):
        path = self.folder / "1.episode"
        row = {**self.rows[0], "decisions": "1"}
        console = SETTINGS.replace("full", "console")
        for action in (18, 25, 37, 64, 81, 177):
            path.write_bytes(log(row, console, bytes([action])))
            assert read_log(path).actions == bytes([action])
            path.write_bytes(log(row, actions=bytes([action])))
            with pytest.raises(errors.BadInput, match=f"has the action {action}; expected 0 to 17, or others with"):
                read_log(path)
        for action in (38, 63, 82, 178, 255):
            path.write_bytes(log(row, console, bytes([action])))
            with pytest.raises(errors.BadInput, match=f"has the action {action}; expected 0 to 17, or others with"):
                read_log(path)

    def test_contents_that_grow_without_end(self):
        self.log.write_bytes(seal(bytes(2**25), size=1000))
        self.check_refusal("1.episode is damaged: its contents do not have 1000 bytes")
        self.log.write_bytes(seal(bytes(2**25)))
        self.check_refusal("1.episode has contents of 33554432 bytes; expected at most 2097152")

    def test_a_log_of_another_image_or_score_or_seed(self):
        for column, value in (("image_md5", "aa"), ("score", "2"), ("environment_seed", "8"), ("state_hash", "0" * 16)):
            self.log.write_bytes(log({**self.rows[0], column: value}))
            self.check_refusal(f"line 2: {column} is '{self.rows[0][column]}'; its log has '{value}'")

    def test_a_score_that_is_raised_by_one_or_an_action_that_is_changed(self):
        write_rows(self.folder, [{**self.rows[0], "score": "2"}, *self.rows[1:]])
        self.check_refusal("line 2: score is '2'; its log has '1'")
        write_rows(self.folder, self.rows)
        self.log.write_bytes(log(self.rows[0], actions=bytes([3] * 299 + [4])))
        self.check_refusal("line 2: log_digest is ")
        self.log.write_bytes(log(self.rows[0], actions=bytes([18] * 300)))
        self.check_refusal("has the action 18; expected 0 to 17, or others with action_set=console")

    def test_strengths_of_paddles(self):
        actions = bytes([3] * 300)
        path = self.folder / "1.episode"
        path.write_bytes(log(self.rows[0], actions=actions + struct.pack("<300f", *[0.5] * 299, 1)))
        read = read_log(path)
        assert (read.actions, read.strengths) == (actions, (0.5,) * 299 + (1.0,))
        assert read.columns["state_hash"] == self.rows[0]["state_hash"]
        packed = read.link("x").removeprefix("replay=").split("&")[0]
        acts = json.loads(zlib.decompress(base64.urlsafe_b64decode(packed + "==")))["acts"]
        assert acts == ["3@0.5*299", "3"]
        path.write_bytes(log(self.rows[0], actions=actions + b"1234"))
        with pytest.raises(errors.BadInput, match="does not fit its actions"):
            read_log(path)

    def test_other_settings_than_those_of_the_preset(self):
        settings = "frame_skip=5 sticky=0.25 action_set=full max_episode_frames=18000"
        self.log.write_bytes(log(self.rows[0], settings))
        self.rows[0]["log_digest"] = hashlib.sha256(self.log.read_bytes()).hexdigest()
        write_rows(self.folder, self.rows)
        self.check_refusal("line 2: the settings of its log are those of machado2018; expected paper2013")

    def test_names_that_leave_the_folder(self):
        for column in ("unit", "episode"):
            for name in ("../../b", "/etc/passwd", "..", "", "a b"):
                number = "3" if column == "unit" else name
                write_rows(self.folder, [{**self.rows[0], "episode": number, column: name}])
                self.check_refusal("")

    def test_links_are_not_followed(self):
        self.log.rename(self.root / "elsewhere")
        self.log.symlink_to(self.root / "elsewhere")
        self.check_refusal("1.episode is a link; expected a file")
        self.log.unlink()
        (self.root / "elsewhere").rename(self.log)
        self.log.parent.rename(self.root / "unit")
        self.log.parent.symlink_to(self.root / "unit")
        self.check_refusal("is a link; expected a folder")
        self.log.parent.unlink()
        (self.root / "unit").rename(self.log.parent)
        (self.folder / "logs").rename(self.root / "logs")
        (self.folder / "logs").symlink_to(self.root / "logs")
        self.check_refusal("a/logs is a link; expected a folder")
        (self.folder / "logs").unlink()
        (self.root / "logs").rename(self.folder / "logs")
        for name in ("agent.toml", "results.csv"):
            (self.folder / name).rename(self.root / "elsewhere")
            (self.folder / name).symlink_to(self.root / "elsewhere")
            self.check_refusal(f"a/{name} is a link; expected a file")
            (self.root / "elsewhere").replace(self.folder / name)

    def test_pipes_are_not_read(self):
        for path in (self.log, *(self.folder / name for name in ("curves.csv", "results.csv", "agent.toml"))):
            path.unlink(missing_ok=True)
            os.mkfifo(path)
            self.check_refusal(f"{path.name} is a pipe, a socket or a device; expected ")

    def test_a_curve_of_an_unknown_game(self):
        (self.folder / "curves.csv").write_text("game,agent,trial,episode,score,frames\nponk,mine,1,1,-20,1000\n")
        self.check_refusal("curves.csv, line 2: unknown game 'ponk'; did you mean pong?")

    def test_errors_do_not_move_the_cursor(self):
        path = self.folder / "agent.toml"
        path.write_text(path.read_text() + '"\\u001b[2Jred" = 1\n')
        self.check_refusal(r"unknown key '\x1b[2Jred'; accepted: ")

    def test_seeds_of_a_phrase(self):
        path = self.folder / "agent.toml"
        path.write_text(path.read_text() + 'phrase = "a phrase"\n')
        self.check_refusal("line 2: environment_seed is '7'; the phrase gives '")
        assert seed_of_phrase("a phrase", {"game": "beamfall", "trial": "1", "episode": "2"}) == 221384134
        for row in self.rows:
            row["environment_seed"] = str(seed_of_phrase("a phrase", row))
            log_path(self.folder, row).write_bytes(log(row))
            row["log_digest"] = hashlib.sha256(log(row)).hexdigest()
        write_rows(self.folder, self.rows)
        assert len(read_submission(self.folder).episodes) == len(self.rows)

    def test_agent_toml(self):
        path = self.folder / "agent.toml"
        good = path.read_text()
        for text, sentence in (
            ("agent = ", "agent.toml is not TOML: "),
            (good + "colour = 1\n", "unknown key 'colour'; accepted: agent, version,"),
            (good.replace("version", "# version"), "agent.toml lacks the key 'version'; expected agent, version,"),
            (good.replace('"mine"', "5"), "agent is 5; expected a text"),
            (good.replace('"mine"', '"../mine"'), "agent is '../mine'; expected 1 to 64 letters, digits"),
            (good.replace("paper2013", "paper2014"), "preset is 'paper2014'; expected paper2013, machado2018"),
            (good.replace("https://example.org/agent", "javascript:alert(1)"), "expected https://... or http://..."),
            (good.replace("4000000", "true"), "training_frames is true; expected a whole number from 0"),
            (good.replace("4000000", str(10**15)), f"training_frames is {10**15}; expected a whole number from 0"),
            (good.replace("Ours <b>& theirs</b>", "x" * 4001), "words has 4001 letters; expected at most 4000"),
            (good.replace("4000000", "-1"), "training_frames is -1; expected a whole number from 0"),
            (good.replace("org/agent", "org/agent\\n"), "link is 'https://example.org/agent\\n'; expected"),
            (good + 'role = "teacher"\n', "role is 'teacher'; expected learner, planner, baseline"),
            (good.replace("Ours", "Ours" * 2000), "words has "),
            (good.replace("4000000", "1" * 5000), "agent.toml is not TOML: Exceeds the limit"),
            (good.replace("4000000", "0x" + "f" * 5000), "has a whole number of more than 64 bits; expected -9223372"),
            (good.replace("4000000", str(2**63)), "has a whole number of more than 64 bits; expected -9223372"),
            ("#" * 70000, "agent.toml has 70000 bytes; expected a TOML file of at most 65536"),
        ):
            path.write_text(text)
            self.check_refusal(sentence)

    def test_agent_toml_in_the_words_of_verify(self):
        path = self.folder / "agent.toml"
        good = path.read_text().splitlines()
        lines = (package.SOURCE / "tests/evaluation/agent_files.tsv").read_text().splitlines()
        cases = [line.split("\t") for line in lines if not line.startswith("#")]
        assert len(cases) > 25
        for key, line, sentence in cases:
            rest = [each for each in good if not each.startswith(f"{key} =")]
            path.write_text("\n".join([line, *rest, ""]))
            with pytest.raises(errors.BadInput) as raised:
                read_submission(self.folder)
            assert str(raised.value) == f"{path}{sentence}"

    def test_agent_toml_at_its_limits(self):
        path = self.folder / "agent.toml"
        good = path.read_text()
        for frames in (0, 10**15 - 1):
            text = good.replace("4000000", str(frames)).replace("Ours <b>& theirs</b>", "x" * 4000)
            path.write_text(text + "#" * (2**16 - len(text.encode())))
            about = read_submission(self.folder).about
            assert (about.training_frames, len(about.words)) == (frames, 4000)
            assert (about.role, about.link, about.phrase) == ("learner", "https://example.org/agent", "")

    def test_an_agent_that_agent_toml_does_not_name(self):
        (self.folder / "agent.toml").write_text(ABOUT.format(agent="other", preset="paper2013"))
        self.check_refusal("results.csv has the agent 'mine'; expected 'other', as agent.toml has")

    def test_a_trial_that_diverged_has_no_log(self):
        lost = {**self.rows[0], "trial": "9", "unit": "lost", "score": "", "end": "diverged"}
        write_rows(self.folder, [*self.rows, lost])
        assert [each.row for each in read_submission(self.folder).episodes] == self.rows
        write_rows(self.folder, [lost])
        self.check_refusal("results.csv: every trial diverged; expected a score of one trial or more")

    def test_usage(self):
        for arguments, sentence in (
            (("--viewer", "ftp://a", self.folder), "'ftp://a' is not accepted; expected http://"),
            (("--paper",), "expected folders of submissions for --board"),
        ):
            done = self.board(*arguments)
            assert done.returncode == 2
            assert sentence in done.stderr
