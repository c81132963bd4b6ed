"""The program's facts of each game equal those of the specification (docs/spec/games/README.md, 1).

The program reads its own game files (games/catalogue), so that the two can be compared.
"""

import json
import os
import subprocess

import pytest
from tree import ROOT

BINARY = os.environ.get("RACEBEAM_BINARY", str(ROOT / "build/release/racebeam"))
ALL_ACTIONS = 18


def specified():
    files = sorted((ROOT / "docs/spec/games").glob("*.json"))
    return {game["rom"]: game for file in files for game in json.loads(file.read_text())}


def catalogue():
    output = subprocess.run([BINARY, "games", "--json"], check=True, capture_output=True).stdout
    return {game["name"]: game for game in json.loads(output)}


class TestFacts:
    @pytest.fixture(scope="class", autouse=True)
    @classmethod
    def set_up_class(cls):
        cls.specified, cls.catalogue = specified(), catalogue()

    def test_every_game_of_the_specification_is_offered(self):
        assert len(self.specified) == 104
        assert self.specified.keys() - self.catalogue.keys() == set()

    def test_images_actions_modes_and_difficulties_are_the_same(self, subtests):
        for name, game in self.specified.items():
            ours = self.catalogue[name]
            with subtests.test(game=name):
                recognised = [image["md5"] for image in ours["images"] if image["recognised"]]
                assert recognised == game["md5"]
                assert ours["minimal_actions"] == game["minimal_actions"]
                assert ours["legal_actions"] == game.get("legal_actions", ours["legal_actions"])
                if "legal_actions" not in game:
                    assert len(ours["legal_actions"]) == ALL_ACTIONS
                for fact in ("modes", "default_mode", "difficulties"):
                    assert ours[fact] == game[fact], fact
