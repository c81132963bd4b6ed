"""The examples of docs/evaluation.md print what it says, and the cells of the notebook run."""

import json
import os
import pathlib
import re
import subprocess
import sys

import package
import pytest

package.require()

sys.path.insert(0, str(package.SOURCE / "tests/docs"))

import run_examples  # noqa: E402

RACEBEAM = pathlib.Path(os.environ.get("RACEBEAM_BINARY", package.SOURCE / "build/release/racebeam"))
PROGRAM = pathlib.Path(sys.executable).parent / "racebeam-evaluate"


class TestDocument:
    def test_the_program_is_installed(self):
        assert PROGRAM.exists()

    def test_examples(self):
        ran, wrong = run_examples.check("docs/evaluation.md", "shell-session", str(PROGRAM))
        assert ran > 4
        assert wrong == 0

    @pytest.mark.skipif(not RACEBEAM.exists(), reason="the program is not built")
    def test_the_cells_of_the_notebook_run(self):
        notebook = json.loads((package.SOURCE / "evaluation/plan_to_figure.ipynb").read_text())
        cells = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
        assert all(not cell["outputs"] and cell["execution_count"] is None for cell in cells)
        code = "\n".join("".join(cell["source"]) for cell in cells)
        assert code.count("training_episodes = 20") == 1
        done = subprocess.run(
            [sys.executable, "-c", code.replace("training_episodes = 20", "training_episodes = 5")],
            capture_output=True,
            text=True,
            env={**os.environ, "MPLBACKEND": "Agg", "RACEBEAM_BINARY": str(RACEBEAM)},
        )
        assert done.returncode == 0, done.stderr
        assert "70 rows confirmed, 0 wrong, 0 could not be checked" in done.stdout
        assert re.search(r"(?m)^0 +basic +-?\d+\.\d+", done.stdout)
