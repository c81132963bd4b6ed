"""The examples of docs/evaluation.md print what it says, and the cells of the notebook run."""

import json
import os
import pathlib
import subprocess
import sys
import unittest

import package

package.require()

sys.path.insert(0, str(package.SOURCE / "tests/docs"))

import run_examples  # noqa: E402

RACEBEAM = pathlib.Path(os.environ.get("RACEBEAM_BINARY", package.SOURCE / "build/release/racebeam"))
PROGRAM = pathlib.Path(sys.executable).parent / "racebeam-evaluate"


class Document(unittest.TestCase):
    def test_the_program_is_installed(self):
        self.assertTrue(PROGRAM.exists())

    def test_examples(self):
        ran, wrong = run_examples.check("docs/evaluation.md", "shell-session", str(PROGRAM))
        self.assertGreater(ran, 4)
        self.assertEqual(wrong, 0)

    @unittest.skipUnless(RACEBEAM.exists(), "the program is not built")
    def test_the_cells_of_the_notebook_run(self):
        notebook = json.loads((package.SOURCE / "evaluation/plan_to_figure.ipynb").read_text())
        cells = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
        self.assertTrue(all(not cell["outputs"] and cell["execution_count"] is None for cell in cells))
        code = "\n".join("".join(cell["source"]) for cell in cells)
        self.assertEqual(code.count("training_episodes = 20"), 1)
        done = subprocess.run(
            [sys.executable, "-c", code.replace("training_episodes = 20", "training_episodes = 5")],
            capture_output=True,
            text=True,
            env={**os.environ, "MPLBACKEND": "Agg", "RACEBEAM_BINARY": str(RACEBEAM)},
        )
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("70 rows confirmed, 0 wrong, 0 could not be checked", done.stdout)
        self.assertRegex(done.stdout, r"(?m)^0 +basic +-?\d+\.\d+")
