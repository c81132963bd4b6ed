"""The examples of docs/evaluation.md print what it says."""

import pathlib
import sys
import unittest

import package

package.require()

sys.path.insert(0, str(package.SOURCE / "tests/docs"))

import run_examples  # noqa: E402

PROGRAM = pathlib.Path(sys.executable).parent / "racebeam-evaluate"


class Document(unittest.TestCase):
    def test_the_program_is_installed(self):
        self.assertTrue(PROGRAM.exists())

    def test_examples(self):
        ran, wrong = run_examples.check("docs/evaluation.md", "shell-session", str(PROGRAM))
        self.assertGreater(ran, 4)
        self.assertEqual(wrong, 0)


if __name__ == "__main__":
    package.main()
