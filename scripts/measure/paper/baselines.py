"""The section of docs/results.md about baselines: their scores, and whether the paper's are the same."""

import math

from .parts import AGAIN, Part, best, known_cause, number, rows_of

POLICIES = ("random", "const", "perturb")
PAPER_EPISODES = 30  # of Random and Perturb; not printed
MOST_NAMED = 3  # actions that a cause names
EMULATOR = "the emulator or the rules of 2012"


def agrees(policy, score, theirs):
    """A constant action leaves nothing to chance."""
    return score == theirs if policy == "const" else abs(score - theirs) <= abs(theirs) / 5


def shown(score, error):
    return f"{number(score)} ({number(error)})" if error is not None else number(score)


def cause(more, theirs):
    """Why a mean differs from the paper's: by what the same policy scores in other episodes."""
    if more is None:
        return "not known"
    score, error, episodes = more
    if agrees("random", score, theirs):
        return "chance of 30 episodes: the others are within a fifth"
    if abs(score - theirs) <= 2 * math.hypot(error, error * math.sqrt(episodes / PAPER_EPISODES)):
        return "chance: the others are within two standard errors"
    return f"{EMULATOR}: the others differ, too"


def cause_of_const(scores, theirs):
    """Why a constant action has another score in the paper: by its scores after some no-ops."""
    if not scores:
        return "not known"
    if theirs in scores:
        return "the frame in which play begins: after some no-ops, it is the paper's score"
    if scores[0] < theirs < scores[-1]:
        return "the frame in which play begins: no-ops give lower and higher scores"
    if len(scores) > 1:
        return f"the frame in which play begins, or {EMULATOR}: none of these starts gives the paper's score"
    return f"{EMULATOR}: none of these starts gives the paper's score"


def equal_actions(actions):
    """The end of a cause: other actions whose score is the paper's."""
    return f"; the paper's score is that of {', '.join(actions[:MOST_NAMED])} here" if actions else ""


class Baselines(Part):
    """Scores of Random, and of the best Const and Perturb policies."""

    def baselines(self):
        self.add("## Baselines")
        if self.lacks("baselines"):
            return
        found = self.figures["baselines"]
        each = self.baseline_scores()
        rows, others, count = [], [], dict.fromkeys(POLICIES, 0)
        for game in found["games"]:
            cells, differ = [], []
            for policy in POLICIES:
                score, agent = each[policy].get(game, (None, ""))
                theirs = self.paper.get(game, {}).get(policy)
                if None not in (score, theirs):
                    same = agrees(policy, score, theirs)
                    count[policy] += same
                    if not same:
                        differ.append(policy)
                        others.append((game, policy, agent, score, theirs))
                action = [] if policy == "random" else [agent.partition("_")[2] or "-"]
                cells += [number(score), *action, number(theirs)]
            rows.append([game, *cells, ", ".join(differ) or "all agree"])
        self.say(f"""Scores are means of {found["settings"]["random"]["evaluation_episodes"]} episodes. For Const and
            Perturb, the table has the best of 18 policies, and its action. Random and Perturb agree with the paper if
            their score is within a fifth of the paper's. Without sticky actions, a constant action leaves nothing to
            chance, so Const agrees only if the scores are equal.""")
        self.not_again(each["perturb"], len(found["games"]))
        counts = ", ".join(f"{number} for {policy.capitalize()}" for policy, number in count.items())
        self.say(f"""The number of games that agree, of {len(found["games"])}: {counts}. The last column names the
            policies that do not agree.""")
        titles = ["Random", "paper", "Const", "action", "paper's Const"]
        titles += ["Perturb", "action of Perturb", "paper's Perturb"]
        self.add(rows_of(["game", *titles, "do not agree"], *rows))
        if others:
            self.disagreements(others)

    def baseline_scores(self):
        """{policy: {game: (score, agent)}}, of const and perturb the best; Perturb as it is now."""
        found = self.figures["baselines"]
        each = {"random": {game: (score, "random") for game, score in found["scores"]["random"].items()}}
        each["const"] = best(found, "const")
        each["perturb"] = best(self.figures.get("perturb", found), "perturb")
        return each

    def not_again(self, perturb, games):
        if len(perturb) < games:
            self.say(f"""Perturb, which once chose an action for 5 frames, has been run again in {len(perturb)} of
                {games} games. The other games have a dash.""")

    def disagreements(self, cells):
        """A table of the cells that do not agree with the paper's, with causes."""
        errors = self.of_plans("errors", ("perturb",))
        number_of = {
            policy: settings["evaluation_episodes"]
            for name in AGAIN
            for policy, settings in self.figures.get(name, {}).get("settings", {}).items()
        }
        counts = ", ".join(f"{number_of[policy]} of {policy.capitalize()}" for policy in number_of)
        self.say(f"""The next table has the scores that do not agree, with their standard errors in brackets, and their
            causes. "In other episodes" is the score of the same policy in plans with `seed = 2`:
            {counts or "none yet"}. It corrects a bias: the best of 18 means is usually higher than the expected score
            of its policy. The paper does not print its number of episodes; the causes assume {PAPER_EPISODES}. The
            other episodes of Const begin with 0 to 29 no-ops (`noop_max=30`), drawn for each; the column has their
            lowest and highest score. The action that is best here need not be the paper's. If others give the paper's
            score, the cause names up to three of them. Causes that experiments have shown are those of `causes.csv` and
            `not_comparable.csv` in `evaluation/racebeam_evaluation/data`, which `racebeam-evaluate` prints, too.""")
        rows = []
        for game, policy, agent, score, theirs in cells:
            others, why = self.others(game, policy, agent, theirs)
            error = errors.get(agent, {}).get(game)
            row = [game, agent.replace("_", " "), shown(score, error), others, number(theirs)]
            rows.append([*row, (known_cause(game, policy) or why) + equal_actions(self.equal(game, policy, theirs))])
        self.add(rows_of(["game", "policy", "score", "in other episodes", "paper's", "cause"], *rows))

    def others(self, game, policy, agent, theirs):
        """The scores of other episodes, and the cause that they show."""
        if policy == "const":
            scores = self.of_plans("distinct", AGAIN).get(agent, {}).get(game, [])
            extent = " to ".join(dict.fromkeys(number(score) for score in (*scores[:1], *scores[-1:])))
            return extent or "-", cause_of_const(scores, theirs)
        each = [self.of_plans(key, AGAIN).get(agent, {}).get(game) for key in ("scores", "errors", "episodes")]
        more = None if None in each else each
        return shown(*more[:2]) if more else "-", cause(more, theirs)

    def equal(self, game, policy, theirs):
        """The actions of Const whose score is the paper's."""
        return [action for action, score in self.consts(game).items() if policy == "const" and score == theirs]

    def consts(self, game):
        """{action: score of Const}."""
        scores = self.figures["baselines"]["scores"]
        return {
            agent.partition("_")[2]: each[game]
            for agent, each in scores.items()
            if agent.startswith("const_") and game in each
        }

    def of_plans(self, key, plans):
        """{agent: {game: figure}} of all plans together."""
        together = {}
        for name in plans:
            for agent, each in self.figures.get(name, {}).get(key, {}).items():
                together.setdefault(agent, {}).update(each)
        return together
