"""The workflow and the hooks name presets, scripts and tests that exist."""

import json
import re
import unittest

from tree import ROOT

FILES = (".github/workflows/ci.yml", ".pre-commit-config.yaml")


def presets():
    named = json.loads((ROOT / "CMakePresets.json").read_text())
    return {preset["name"] for preset in named["configurePresets"] if not preset.get("hidden")}


class Workflow(unittest.TestCase):
    def named(self, pattern):
        found = [name for file in FILES for name in re.findall(pattern, (ROOT / file).read_text())]
        self.assertTrue(found, pattern)
        return set(found)

    def test_its_presets_exist(self):
        self.assertEqual(self.named(r"--preset ([\w-]+)") - presets(), set())

    def test_its_scripts_exist(self):
        names = self.named(r"(?<![\w/])((?:scripts|\.ci|tests)/[\w./-]+)")
        self.assertEqual({name for name in names if not (ROOT / name).is_file()}, set())


if __name__ == "__main__":
    unittest.main()
