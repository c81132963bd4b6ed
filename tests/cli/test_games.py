"""racebeam games and racebeam roms."""

import gzip
import hashlib
import json
import os
import re
import shutil
import zipfile

import cartridges
import pytest
from harness import rom, run


def answer(*words):
    status, printed, errors = run(*words)
    assert (status, errors) == (0, []), errors
    return printed.decode()


class TestGames:
    @pytest.fixture(autouse=True)
    def set_up(self):
        self.games = {game["name"]: game for game in json.loads(answer("games", "--json"))}

    def test_all_games_of_the_reference_are_there_with_their_rules(self):
        theirs = [game for game in self.games.values() if game["rule"] == "ale-0.12" and not game["built_in"]]
        assert len(theirs) == 104
        for game in theirs:
            md5s = [image["md5"] for image in game["images"] if image["recognised"]]
            assert [len(md5) for md5 in md5s] == [32], game["name"]

    def test_what_is_known_of_a_game(self):
        skiing = self.games["skiing"]
        assert skiing["title"] == "Skiing"
        assert skiing["legal_actions"] == [
            "NOOP",
            "UP",
            "RIGHT",
            "LEFT",
            "DOWN",
            "UPRIGHT",
            "UPLEFT",
            "DOWNRIGHT",
            "DOWNLEFT",
        ]
        berzerk = self.games["berzerk"]
        assert (berzerk["modes"], berzerk["default_mode"]) == ([*range(1, 10), 16, 17, 18], 1)
        assert self.games["asteroids"]["difficulties"] == [0, 3]

    def test_the_games_that_are_built_in_are_marked(self):
        assert self.games["beamfall"]["built_in"]
        assert not self.games["pong"]["built_in"]

    def test_rules_tell_whose_they_are_and_what_is_corrected(self):
        ours = [name for name, game in self.games.items() if game["rule"] == "racebeam" and not game["built_in"]]
        assert ours == ["combat", "joust", "maze_craze", "warlords"]
        assert self.games["seaquest"]["fixed"]["wraps"] == 1000000
        assert self.games["freeway"]["fixed"] is None
        assert "RIGHT" in self.games["casino"]["fixed"]["minimal_actions"]
        assert self.games["tennis"]["two_player_modes"] == [1, 3]
        rows = answer("games", "--rules").splitlines()
        assert [row.split()[0] for row in rows[1:]] == list(self.games)
        assert re.search(
            r"ale-0.12 +no +- +The score may wrap at 1000000", next(row for row in rows if row.startswith("seaquest "))
        )
        assert re.search(r"racebeam +yes +1-3 5-8 10-13", next(row for row in rows if row.startswith("warlords ")))

    def test_one_game_is_described(self):
        lines = answer("games", "pong").splitlines()
        assert lines == [
            "name          pong: Pong (Video Olympics)",
            "image         MD5 60e0ea3cbe0913d39803477945e9e5ec",
            "console       paddles on the left, paddles on the right; scheme auto, format auto",
            "modes         0-1; of two players: 2-49 (default 0)",
            "difficulties  0-3 (default 0)",
            "minimal       NOOP FIRE RIGHT LEFT RIGHTFIRE LEFTFIRE",
            "legal         NOOP FIRE UP RIGHT LEFT DOWN UPRIGHT UPLEFT DOWNRIGHT DOWNLEFT UPFIRE RIGHTFIRE",
            "              LEFTFIRE DOWNFIRE UPRIGHTFIRE UPLEFTFIRE DOWNRIGHTFIRE DOWNLEFTFIRE",
            "rule          that of ALE 0.12; player B gets rewards, too",
        ]
        assert "racebeam's own; player B gets rewards, too" in answer("games", "warlords")
        assert re.search(r"rules fixed +The score may wrap at 1000000\.", answer("games", "seaquest"))
        assert re.search(r"modes +0 2; of two players: 1 3 \(default 0\)", answer("games", "tennis"))
        assert "part of this program" in answer("games", "beamfall")
        assert all(len(line) <= 100 for line in answer("games", "seaquest").splitlines())

    def test_one_game_as_json_is_its_row(self):
        assert json.loads(answer("games", "pong", "--json")) == [self.games["pong"]]

    def test_an_unknown_game_is_answered_with_similar_names(self):
        assert run("games", "pongg") == (1, b"", ["racebeam: unknown game 'pongg'; did you mean pong?"])
        assert "unknown game 'xyzzy'; racebeam games lists them" in run("games", "xyzzy")[2][0]
        assert run("games", "pong", "--rules")[0] == 2

    def test_the_table_has_a_row_for_each(self):
        rows = answer("games").splitlines()
        assert [row.split()[0].rstrip("*") for row in rows[1:]] == list(self.games)
        for row, game in zip(rows[1:], self.games.values()):
            recognised = [image["md5"] for image in game["images"] if image["recognised"]]
            assert re.search(r" ([0-9a-f]{32}|-) +(yes|no) ", row)[1] == (recognised or ["-"])[0]
        assert re.search(r" 0 +1-9 16-18$", next(row for row in rows if row.startswith("berzerk ")))
        pong = next(row for row in rows if row.startswith("pong "))
        assert "60e0ea3cbe0913d39803477945e9e5ec" in pong
        assert any(row.startswith("beamfall") and "*" in row for row in rows)


@pytest.mark.usefixtures("self_folder")
class TestRoms:
    def put(self, name, data):
        with open(os.path.join(self.folder, name), "wb") as file:
            file.write(data)

    def findings(self):
        report = json.loads(answer("roms", self.folder, "--json"))
        return {image["file"]: image for image in report["images"]}, report["missing"]

    def test_control_characters_in_names_are_shown_not_obeyed(self):
        name = "red\x1b[31m\nnext\x9b1m L\u00f6we.bin"
        self.put(name, bytes(range(256)) * 16)
        text = answer("roms", self.folder)
        assert "red\\x1b[31m\\x0anext\\xc2\\x9b1m L\u00f6we.bin" in text
        for output in (text, answer("roms", self.folder, "--json")):
            assert [c for c in output if c < " " and c != "\n" or "\x7f" <= c < "\xa0"] == []
        assert name in self.findings()[0]

    def test_each_image_gets_its_verdict(self):
        mystery = bytes(range(256)) * 16
        self.put("mystery.bin", mystery)
        self.put("PONG.A26", mystery[::-1])
        self.put("packed.bin.gz", gzip.compress(mystery))
        self.put("empty.rom", b"")
        self.put("notes.txt", b"no image")
        os.mkdir(os.path.join(self.folder, "folder.bin"))
        found, missing = self.findings()
        assert {name: image["verdict"] for name, image in found.items()} == {
            "mystery.bin": "unknown",
            "PONG.A26": "by-name",
            "packed.bin.gz": "unknown",
            "empty.rom": "unusable",
        }
        assert found["PONG.A26"]["game"] == "pong"
        assert found["mystery.bin"]["md5"] == hashlib.md5(mystery).hexdigest()
        assert found["packed.bin.gz"]["md5"] == found["mystery.bin"]["md5"]
        assert "--game" in found["mystery.bin"]["note"]
        assert found["empty.rom"]["note"] == "the file is empty"
        assert "pong" not in missing
        assert "breakout" in missing

    def test_archives_are_read_and_files_without_a_cartridge_are_unusable(self):
        image = bytes(range(256)) * 16
        for name, files in (
            ("one.zip", {"pong.bin": image, "readme.txt": b"hello"}),
            ("two.zip", {"a.bin": image, "b.bin": image}),
        ):
            with zipfile.ZipFile(os.path.join(self.folder, name), "w", zipfile.ZIP_DEFLATED) as archive:
                for file, data in files.items():
                    archive.writestr(file, data)
        self.put("seven.7z", b"7z\xbc\xaf\x27\x1c" + image)
        self.put("odd.bin", image[:3000])
        self.put("modern.bin", image[:700] + b"LENIN" + bytes(32768 - 705))
        self.put("small.bin", image[:1024])
        found, _ = self.findings()
        assert {name: (image["verdict"], image["scheme"]) for name, image in found.items()} == {
            "one.zip": ("by-name", "2K"),
            "two.zip": ("unusable", ""),
            "seven.7z": ("unusable", ""),
            "odd.bin": ("unusable", ""),
            "modern.bin": ("unusable", ""),
            "small.bin": ("unknown", "2K"),
        }
        assert found["one.zip"]["md5"] == hashlib.md5(image).hexdigest()
        for file, sentence in (
            ("two.zip", "a.bin, b.bin"),
            ("seven.7z", "7z archives are not read"),
            ("odd.bin", "3000 bytes"),
            ("modern.bin", "scheme CTY, which is not implemented"),
        ):
            assert sentence in found[file]["note"]
        output = run("serve", "--stdio", "--roms", self.folder, data=b"games\n")[1]
        names = sorted({"pong", "small", *cartridges.OURS})
        assert output.decode() == f"ok count={len(names)} games={','.join(names)}\n"

    def test_an_empty_folder_lacks_every_game_but_the_built_in_ones(self):
        games = json.loads(answer("games", "--json"))
        found, missing = self.findings()
        assert found == {}
        assert missing == [game["name"] for game in games if not game["built_in"]]

    @pytest.mark.needs_roms("pong")
    def test_an_image_is_known_by_its_bytes_whatever_it_is_called(self):
        shutil.copy(rom("pong"), os.path.join(self.folder, "breakout.bin"))
        found, missing = self.findings()
        assert (found["breakout.bin"]["verdict"], found["breakout.bin"]["game"]) == ("known", "pong")
        assert "breakout" in missing

    def test_the_text_ends_with_the_counts(self):
        self.put("mystery.bin", b"\xea" * 4096)
        image, counts = answer("roms", self.folder).splitlines()
        hint = "--game NAME or --game-file FILE selects a rule"
        assert re.search(rf"^unknown +- +[0-9a-f]{{32}}  2K +mystery\.bin: {hint}$", image)
        assert re.search(r"^1 image; \d+ games without one \(--missing lists them\)$", counts)

    def test_a_link_to_what_is_not_there_is_unusable(self):
        self.put("real.bin", b"\xea" * 4096)
        for name, target in (("pong.bin", "/nowhere/pong.bin"), ("b.zip", "gone.zip"), ("a.rom", "real.bin")):
            os.symlink(target, os.path.join(self.folder, name))
        os.symlink("gone", os.path.join(self.folder, "notes.txt"))
        found, missing = self.findings()
        assert {name: image["verdict"] for name, image in found.items()} == {
            "a.rom": "unknown",
            "b.zip": "unusable",
            "pong.bin": "unusable",
            "real.bin": "unknown",
        }
        assert found["pong.bin"]["note"] == "a link to '/nowhere/pong.bin', which is not there"
        assert "pong" in missing
        assert "pong.bin: a link to '/nowhere/pong.bin', which is not there\n" in answer("roms", self.folder)

    def test_a_folder_that_is_a_link_to_what_is_not_there(self):
        link = os.path.join(self.folder, "link")
        os.symlink("gone", link)
        self.check_refusal(link, f"cannot list the folder '{link}': it is a link to 'gone', which is not there")

    def test_the_games_without_an_image_are_listed_on_request(self):
        self.put("mystery.bin", b"\xea" * 4096)
        lines = answer("roms", self.folder, "--missing").splitlines()
        missing = [line.split()[1] for line in lines if line.startswith("missing ")]
        assert missing == self.findings()[1]
        assert lines[-1] == f"1 image; {len(missing)} games without one"

    def check_refusal(self, folder, complaint):
        status, printed, errors = run("roms", folder)
        assert (status, printed, len(errors)) == (1, b"", 1), errors
        assert complaint in errors[0]

    def test_a_folder_that_is_not_there(self):
        self.check_refusal(os.path.join(self.folder, "missing"), "No such file or directory")

    def test_a_file_for_a_folder(self):
        self.put("file", b"")
        self.check_refusal(os.path.join(self.folder, "file"), "Not a directory")

    @pytest.mark.skipif(os.geteuid() == 0, reason="root may read everything")
    def test_a_folder_that_may_not_be_read(self, cleanup):
        os.chmod(self.folder, 0)
        cleanup(os.chmod, self.folder, 0o700)
        self.check_refusal(self.folder, "Permission denied")
