#!/usr/bin/env python3
"""Writes docs/results.md from the figures of docs/results/figures, so that no figure is typed by hand.

    paper_results.py [FOLDER] [--into FILE]

FOLDER has PLAN.json for plans of PLANS, as scripts/measure/plan_figures.py gathers them; docs/results/figures unless it
is named. A plan without figures is said to be not run yet. random-again.json, const-again.json and perturb-again.json
have other episodes of the policies that do not agree with the paper. perturb-sample.json has units of a plan that were
run again. Published scores are those of evaluation/.
"""

import argparse
import pathlib
import sys

from paper.baselines import Baselines
from paper.conditions import Conditions
from paper.learners import Learners
from paper.logs import Logs
from paper.pairs import Pairs
from paper.searches import Searches
from plan_figures import FIGURES, ROOT


class Document(Conditions, Baselines, Learners, Pairs, Searches, Logs):
    """docs/results.md."""

    def text(self):
        self.introduction()
        self.conditions()
        self.scale()
        self.differences()
        self.changes()
        self.baselines()
        self.learners()
        self.long_training()
        self.whole_training()
        self.pairs()
        self.searches()
        self.simulations()
        self.verification()
        self.logs()
        return "\n\n".join(self.parts) + "\n"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("folder", type=pathlib.Path, nargs="?", default=FIGURES)
    parser.add_argument("--into", type=pathlib.Path, default=ROOT / "docs/results.md")
    options = parser.parse_args()
    if options.folder != FIGURES and not options.folder.is_dir():
        sys.exit(f"paper_results.py: the folder {options.folder} does not exist")
    options.into.write_text(Document(options.folder).text())


if __name__ == "__main__":
    main()
