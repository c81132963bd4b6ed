"""The sections of docs/results.md about learners."""

import statistics

from plan_figures import ROOT

from .parts import Part, agreement, known_cause, number, published_training, rows_of
from .student import bounds

LEARNERS = {"basic": 8000, "lsh": 4000, "disco": 3000, "bass": 1000, "ram": 500}  # decisions a second: the goals

ENOUGH = 0.9  # of the published score

RATIOS = ("agent", "games", "score above the published", "median of score / published", "lowest", "highest")


def training(settings):
    """How long an agent was trained, in the words of protocols.csv."""
    for unit in ("episodes", "frames"):
        if count := settings.get(f"training_{unit}"):
            return f"{count:,} {unit}"
    return ""


def summary(ratios):
    """The columns of RATIOS after the agent."""
    above = sum(ratio > 1 for ratio in ratios)
    parts = (statistics.median(ratios), min(ratios), max(ratios))
    return [str(len(ratios)), str(above), *(number(part, 2) for part in parts)]


def tenth(trials):
    """A part of a learning curve: the mean over trials, and half of its interval."""
    mean, within = statistics.mean(trials), bounds(trials)
    digits = 0 if mean >= 100 else 1
    return number(mean, digits) + (f" ± {number(mean - within[0], digits)}" if within else "")


class Learners(Part):
    """Scores of learners."""

    def learners(self):
        self.add("## Learners, in an hour")
        if self.lacks("hour"):
            return
        found = self.figures["hour"]
        scores = found["scores"]
        agents = [agent for agent in scores if agent in LEARNERS]
        random, trial = scores["random"], found["settings"][agents[0]]
        self.say(f"""{trial["trials"]} trials of {trial["training_frames"] // trial["frame_skip"]:,} decisions and
            {trial["evaluation_episodes"]} evaluation episodes each. All together took
            {number(found["seconds"] / 7200, 2)} hours of processor time on each of two cores (goal: 1, at most 1.5),
            without the discovery of backgrounds and classes. In brackets are the paper's scores, after 5,000 episodes.
            They are not expected to agree, because training is so much shorter here.""")
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
        self.speeds_of_learners(found, agents)
        self.picture("learning-curves", "Scores of training episodes by frames, a panel for each game")

    def speeds_of_learners(self, found, agents):
        """In how many games each learner is above Random, and its decisions a second."""
        scores, speeds = found["scores"], found["speeds"]
        random, trial = scores["random"], found["settings"][agents[0]]
        self.say(f"""The next table has the number of games in which the mean of a learner is above that of Random
            (goal: at least three), and the learner's speed, emulation included. {trial["trials"]} trials are too few
            to tell such a difference from chance. `racebeam-evaluate` computes an interval for the number of games,
            and tests each game. A mean that the table above shows as 0.0 can be above 0.""")
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
        trained_for = published_training()
        self.lacks(*(name for name in ("learners", "ram", "blob_prost") if name not in plans))
        if not plans:
            return
        self.say("""Training and evaluation are as long as in the paper: 5,000 and 500 episodes. Blob-PROST trains for
            2,000 episodes, which is a small part of the published training. It also chooses from all 18 actions, unlike
            its authors' program ([paper-notes.md](paper-notes.md#successors)). A score is the mean over trials of the
            mean over their episodes. The 95 % interval is by Student's t over trials; a single trial has no interval. A
            score agrees with the published one if its interval contains it.""")
        self.say("""Such an agreement is weak evidence. With three trials, the interval reaches 2.5 standard deviations
            of the trials to each side. The published mean has an interval, too, which nobody printed. And these five
            games are not independent of the agents: where the paper is silent, their scores decided some defaults
            ([paper-notes.md](paper-notes.md)).""")
        rows, curves, ratios, causes = [], [], {}, []
        for game, agent, found in self.trained(plans):
            theirs, score = self.paper[game].get(agent), found["scores"][agent][game]
            trials = found["trials"][agent][game]
            row = [game, agent, str(len(trials)), f"{found['episodes'][agent][game]:,}", number(score)]
            row += [" to ".join(map(number, bounds(trials) or ())) or "-", number(theirs)]
            same = agreement(trials, theirs, "trial")
            if (published := trained_for.get(agent)) != training(found["settings"][agent]):
                same = f"not comparable: the published agent was trained for {published}"
            elif theirs:
                ratios.setdefault(agent, []).append(score / theirs)
                if same == "no" or score / theirs < ENOUGH:
                    cause = known_cause(game, agent) or "unknown"
                    causes.append([game, agent, number(score / theirs, 2), same, cause])
            rows.append([*row, number(score / theirs, 2) if theirs else "-", same])
            curves.append([game, agent, *(tenth(part) for part in zip(*found["curves"][agent][game]))])
        header = ["game", "agent", "trials", "episodes", "score", "95 % interval", "published", "score / published"]
        self.add(rows_of([*header, "agrees"], *rows))
        if ratios:
            self.say("The next table has the same ratios by agent, without those that are not comparable.")
            self.add(rows_of(RATIOS, *([agent, *summary(each)] for agent, each in ratios.items())))
        if causes:
            self.say(f"""The next table has the scores that do not agree, and those below {ENOUGH} of the published
                score. The causes are those of `causes.csv` in `evaluation/racebeam_evaluation/data`;
                paper-notes.md has the experiments ([the end of
                training](paper-notes.md#the-end-of-training), [DISCO and
                LSH](paper-notes.md#disco-and-lsh-above-the-paper)).""")
            self.add(rows_of(["game", "agent", "score / published", "agrees", "cause"], *causes))
        self.picture("learning-curves-whole", "Scores of whole training by frames, a panel for each game")
        self.say("""Trials have equal numbers of episodes, not of frames. Where a trial has ended, the curve is the mean
            of the others, so that it can jump.""")
        self.say("""The next table has the mean scores of training episodes, by tenths of the training. After the
            sign ± is half of the 95 % interval, by Student's t over the trials, if there are several. The agent
            explores in training as it does in evaluation.""")
        width = max(len(row) for row in curves)
        tenths = [f"{place}" for place in range(1, width - 1)]
        self.add(rows_of(["game", "agent", *tenths], *(row + ["-"] * (width - len(row)) for row in curves)))

    def picture(self, name, caption):
        """A picture of the report of racebeam-evaluate, if docs/pictures has it."""
        if (ROOT / f"docs/pictures/{name}.svg").exists():
            self.add(f"![{caption}](pictures/{name}.svg)")
            self.say("`racebeam-evaluate` drew the picture. Its bands are standard errors over the trials.")

    def trained(self, plans):
        """(game, agent, figures) of each learner that was trained in a game, by game."""
        every = [
            (game, agent, self.figures[plan])
            for plan in plans
            for agent, games in self.figures[plan]["trials"].items()
            for game in games
        ]
        return sorted(every, key=lambda each: each[0])
