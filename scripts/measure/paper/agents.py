"""The sections of docs/results.md about baselines and learners."""

import math
import statistics

from plan_figures import ROOT

from .parts import AGAIN, PARTIAL, Part, best, number, rows_of

LEARNERS = {"basic": 8000, "lsh": 4000, "disco": 3000, "bass": 1000, "ram": 500}  # decisions a second: the goals
# The 97.5 % quantile of Student's t for 1, 2, ... degrees of freedom.
STUDENT = (12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262)
PAPER_EPISODES = 30  # of Perturb; not printed
# Causes that a comparison of scores does not find.
CAUSES = {
    "skiing": "the reward was near 0 then, and adds up to about -17,000 for random play now",
}


def interval(trials):
    """The 95 % interval of a mean over trials, by Student's t."""
    if len(trials) < 2:
        return "-"
    half = STUDENT[len(trials) - 2] * statistics.stdev(trials) / len(trials) ** 0.5
    mean = statistics.mean(trials)
    return f"{number(mean - half)} to {number(mean + half)}"


def mean_and_error(found, agent, game):
    """The mean score of an agent, its standard error and the number of episodes, or None."""
    score = found["scores"].get(agent, {}).get(game)
    return None if score is None else (score, found["errors"][agent][game], found["episodes"][agent][game])


def shown(score, error):
    return f"{number(score)} ({number(error)})" if error is not None else number(score)


def cause(more, theirs):
    """Why 30 episodes differ from the paper's score: by what the same policy scores in others."""
    if more is None:
        return "not known"
    score, error, episodes = more
    if abs(score - theirs) <= abs(theirs) / 5:
        return "chance of 30 episodes: the others are within a fifth"
    if abs(score - theirs) <= 2 * math.hypot(error, error * math.sqrt(episodes / PAPER_EPISODES)):
        return "chance: the others are within two standard errors"
    return "the emulator or the rules of 2012: the others differ, too"


class Agents(Part):
    """Scores of agents that do not search."""

    def baselines(self):
        self.add("## Baselines")
        if self.lacks("baselines"):
            return
        found = self.figures["baselines"]
        random, const, perturb = (
            found["scores"]["random"],
            best(found, "const"),
            self.perturb_scores(),
        )
        rows = []
        for game in found["games"]:
            theirs = self.paper.get(game, {})
            rows.append(
                [
                    game,
                    number(random[game]),
                    number(theirs.get("random")),
                    number(const[game][0]),
                    const[game][1],
                    number(theirs.get("const")),
                    number(perturb[game][0]) if game in perturb else "-",
                    perturb[game][1] if game in perturb else "-",
                    number(theirs.get("perturb")),
                ]
            )
        near = [
            game
            for game in random
            if game != "skiing"
            and game in self.paper
            and abs(random[game] - self.paper[game]["random"]) <= abs(self.paper[game]["random"]) / 5
        ]
        same = [game for game in const if game in self.paper and const[game][0] == self.paper[game]["const"]]
        self.say(f"""Means of {found["settings"]["random"]["evaluation_episodes"]} episodes. Const and Perturb are the
            best of 18 policies, with
            its action. In {len(near)} of {len(random)} games, the score of Random is within a fifth of the paper's.
            A constant action leaves nothing to chance without sticky actions, so that a difference of Const is one of
            the emulator or of the games' rules: in {len(same)} of {len(const)} games they do not differ.""")
        self.perturb(perturb, len(found["games"]))
        self.add(
            rows_of(
                [
                    "game",
                    "Random",
                    "paper",
                    "Const",
                    "action",
                    "paper's Const",
                    "Perturb",
                    "action of Perturb",
                    "paper's Perturb",
                ],
                *rows,
            )
        )

    def perturb_scores(self):
        """{game: (score, action)} of Perturb as it is now, from all plans that have it."""
        again = [self.figures[name] for name in (PARTIAL, "perturb") if name in self.figures]
        found = {}
        for figures in again or [self.figures["baselines"]]:
            found |= best(figures, "perturb")
        return found

    def perturb(self, perturb, games):
        """How near Perturb is to the paper's. It is within a fifth if the scores differ by at most a fifth of it."""
        if len(perturb) < games:
            self.say(f"""Perturb, which chose an action for 5 frames before, has been run again in {len(perturb)} of
                {games} games. The other games have a dash.""")
        far = [
            game
            for game, (score, _) in perturb.items()
            if (theirs := self.paper.get(game, {}).get("perturb")) is not None and abs(score - theirs) > abs(theirs) / 5
        ]
        self.say(f"""Perturb's score is within a fifth of the paper's in {len(perturb) - len(far)} of {len(perturb)}
            games.""")
        if far:
            self.far_from_the_paper(far, perturb)

    def far_from_the_paper(self, games, perturb):
        """A table of the games in which Perturb's score is not near the paper's, with causes."""
        errors = {}
        for name in (PARTIAL, "perturb"):
            for agent, each in self.figures.get(name, {}).get("errors", {}).items():
                errors.setdefault(agent, {}).update(each)
        again = self.figures.get(AGAIN, {"scores": {}, "errors": {}})
        self.say("""The table has the others. In brackets: the standard error. The best of 18 means is higher than what
            its policy scores in the mean. So a column has the same policy in 200 episodes of a plan with `seed = 2`.
            The paper does not print how many episodes it has; the causes take it for 30.""")
        rows = []
        for game in games:
            (score, action), theirs = perturb[game], self.paper[game]["perturb"]
            agent = f"perturb_{action}"
            more = mean_and_error(again, agent, game)
            rows.append(
                [
                    game,
                    action,
                    shown(score, errors.get(agent, {}).get(game)),
                    shown(*more[:2]) if more else "-",
                    number(theirs),
                    CAUSES.get(game) or cause(more, theirs),
                ]
            )
        self.add(rows_of(["game", "action", "Perturb", "in 200 other episodes", "paper's", "cause"], *rows))

    def learners(self):
        self.add("## Learners, in an hour")
        if self.lacks("hour"):
            return
        found = self.figures["hour"]
        scores = found["scores"]
        agents = [agent for agent in scores if agent in LEARNERS]
        random, trial = scores["random"], found["settings"][agents[0]]
        self.say(f"""{trial["trials"]} trials of {trial["training_frames"] // trial["frame_skip"]:,} decisions and
            {trial["evaluation_episodes"]} evaluation episodes each. All took {number(found["seconds"] / 7200, 2)}
            hours of processor time on
            each of two cores (goal: 1, at most 1.5), the discovery of backgrounds and classes not included. In
            brackets: the paper's
            scores, after 5,000 episodes.""")
        self.add(
            rows_of(
                ["game", "Random", *agents],
                *(
                    [
                        game,
                        f"{number(random[game])} ({number(self.paper[game]['random'])})",
                        *(f"{number(scores[agent].get(game))} ({number(self.paper[game][agent])})" for agent in agents),
                    ]
                    for game in found["games"]
                ),
            )
        )
        self.say(f"""Games in which the mean of each learner is above that of Random (goal: at least three), and its
            speed, emulation included. {trial["trials"]} trials are too few to tell such a difference from chance:
            `racebeam-evaluate` gives the number of games its interval, and tests each game.""")
        speeds = found["speeds"]
        self.add(
            rows_of(
                ["learner", "games above Random", "decisions a second, mean of the games", "lowest", "highest", "goal"],
                *(
                    [
                        agent,
                        str(sum(scores[agent].get(game, random[game]) > random[game] for game in random)),
                        number(statistics.mean(speeds[agent].values()), 0),
                        number(min(speeds[agent].values()), 0),
                        number(max(speeds[agent].values()), 0),
                        number(LEARNERS[agent], 0),
                    ]
                    for agent in agents
                ),
            )
        )
        if (ROOT / "docs/pictures/learning-curves.svg").exists():
            self.add("![Scores of training episodes by frames, a panel for each game](pictures/learning-curves.svg)")

    def long_training(self):
        self.add("## Basic, for 2,000,000 decisions")
        if self.lacks("basic"):
            return
        found = self.figures["basic"]
        scores, random = found["scores"]["basic"], found["scores"]["random"]
        self.add(
            rows_of(
                ["game", "Basic", "paper's Basic", "Random"],
                *(
                    [game, number(scores.get(game)), number(self.paper[game]["basic"]), number(random[game])]
                    for game in found["games"]
                ),
            )
        )

    def whole_training(self):
        self.add("## Learners, whole training")
        plans = [name for name in ("learners", "ram", "blob_prost") if name in self.figures]
        self.lacks(*(name for name in ("learners", "ram", "blob_prost") if name not in plans))
        if not plans:
            return
        self.say("""Training and evaluation are as long as in the paper: 5,000 and 500 episodes. Blob-PROST trains for
            2,000. A score is the mean over trials of the mean over their episodes. The interval is at 95 %, by
            Student's t over trials. A single trial has no interval.""")
        rows, curves = [], []
        for game, agent, found in self.trained(plans):
            theirs, score = self.paper[game].get(agent), found["scores"][agent][game]
            row = [game, agent, str(len(found["trials"][agent][game])), f"{found['episodes'][agent][game]:,}"]
            row += [number(score), interval(found["trials"][agent][game]), number(theirs)]
            rows.append([*row, number(score / theirs, 2) if theirs else "-"])
            curves.append([game, agent, *(number(part, 0) for part in found["curves"][agent][game])])
        header = ["game", "agent", "trials", "episodes", "score", "95 % interval", "published", "score / published"]
        self.add(rows_of(header, *rows))
        self.say("""Mean scores of training episodes, by tenths of the training. Training explores as evaluation
            does.""")
        width = max(len(row) for row in curves)
        tenths = [f"{place}" for place in range(1, width - 1)]
        self.add(rows_of(["game", "agent", *tenths], *(row + ["-"] * (width - len(row)) for row in curves)))

    def trained(self, plans):
        """(game, agent, figures) of each learner that was trained in a game, by game."""
        every = [
            (game, agent, self.figures[plan])
            for plan in plans
            for agent, games in self.figures[plan]["trials"].items()
            for game in games
        ]
        return sorted(every, key=lambda each: each[0])
