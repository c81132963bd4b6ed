"""The section of docs/results.md about tests between learners."""

import itertools
import math

from .parts import Part, number, rows_of
from .student import quantile, welch

SIGNIFICANCE = 0.01  # the paper's, and that of racebeam-evaluate

TESTS = (
    *("game", "pair", "trials", "difference of means", "95 % interval", "p", f"p below {SIGNIFICANCE}"),
    "published difference",
)


class Pairs(Part):
    """Differences between agents in whole training."""

    def pairs(self):
        self.add("## Learners, tests between pairs")
        if self.lacks("learners"):
            return
        found = self.figures["learners"]
        trials = found["trials"]
        tests = [
            (game, first, second, welch(trials[first][game], trials[second][game]))
            for game in found["games"]
            for first, second in itertools.combinations(trials, 2)
            if all(len(trials[agent].get(game, ())) > 1 for agent in (first, second))
        ]
        if not tests:
            self.say("A test needs two trials of each agent.")
            return
        counted = sum(p < SIGNIFICANCE for *_, (_, _, p) in tests)
        self.say("""The table compares the learners of the plan `learners` in pairs, after whole training. The
            difference is that of the means of the trials, first minus second. Its interval and its p are by Welch's
            t-test, as in the report of `racebeam-evaluate`. Trials of two agents have different seeds, so they are not
            paired one by one. The last column has the difference of the published scores.""")
        self.say(f"""{counted} of {len(tests)} differences have a p below {SIGNIFICANCE}, the paper's limit. If no
            agents differed, {number(SIGNIFICANCE * len(tests))} of {len(tests)} would be expected; no p is corrected
            for the number of tests. {power(found)} Pairs that do not differ here can still differ.""")
        self.add(rows_of(TESTS, *(self.test_row(trials, *test) for test in tests)))

    def test_row(self, trials, game, first, second, test):
        """The row of a pair, with the columns of TESTS."""
        difference, bounds, p = test
        counts = [len(trials[agent][game]) for agent in (first, second)]
        theirs = [self.paper.get(game, {}).get(agent) for agent in (first, second)]
        return [
            game,
            f"{first}, {second}",
            " and ".join(map(str, counts)),
            number(difference),
            " to ".join(map(number, bounds)),
            number(p, 3) if p >= 0.001 else "below 0.001",
            "yes" if p < SIGNIFICANCE else "no",
            number(theirs[0] - theirs[1]) if None not in theirs else "-",
        ]


def power(found):
    """How large a difference must be, as a sentence, for agents with the most trials."""
    trials = max(len(each) for games in found["trials"].values() for each in games.values())
    needed = quantile(2 * trials - 2, 1 - SIGNIFICANCE) * math.sqrt(2 / trials)
    return f"""With {trials} trials of each, the power is low: of two agents with equal spreads, the difference must be
        {number(needed)} standard deviations of the trials for such a p."""
