"""The sections of docs/results.md about how the plans were run."""

from .parts import AGAIN, FULL_SEARCHES, PLANS, SAMPLES, Part, episodes, item_of_list, number, rows_of

# Agents that have changed: the plan and the agent; whether settings are those of the agent as it is now; what it did.
CHANGED = (
    (
        "hour",
        "disco",
        lambda settings: "count_instances" in settings,
        "left out objects that hardly move, followed others for 8 pixels a decision, and had two bits for a velocity",
    ),
    (
        "full_tree",
        "full_tree",
        lambda settings: "reuse_tree" in settings,
        "of equal actions, could choose one that ends the episode",
    ),
    (
        "iw1",
        "iw1",
        lambda settings: "reuse_tree" in settings,
        "built its tree anew for each decision, and opened nodes with a reward like others",
    ),
)
# What was scaled down. {iw1}: the games in which IW(1) has a published score; {uct_games} and so on: those here.
SCALE = (
    ("part", "paper", "here", "what that can show", "what it cannot show"),
    (
        "baselines",
        "55 games; number of episodes not printed",
        "55 games, 30 episodes",
        "the paper's columns",
        "differences below the spread of 30 episodes",
    ),
    (
        "learners",
        "55 games, 30 trials of 5,000 episodes",
        "5 games, 2 trials of 200,000 decisions",
        "that each learner learns",
        "scores of whole training; tests between learners",
    ),
    (
        "Basic, longer",
        "5,000 episodes, 30 trials",
        "2,000,000 decisions, 1 trial",
        "scores of long training",
        "the spread over trials",
    ),
    (
        "learners, whole training",
        "55 games, 30 trials of 5,000 episodes",
        "5 games, 3 trials of 5,000 episodes, of RAM 1",
        "scores of whole training",
        "small differences between learners; RAM's spread",
    ),
    (
        "UCT, full tree",
        "55 games, 10 episodes",
        "{uct_games} and {full_tree_games}, 1 episode",
        "the budget's strength and cost",
        "means; other games",
    ),
    ("IW(1)", "{iw1} games", "{iw1_games}, 1 episode", "the same", "the same"),
)
MACHINE = ("processor", "version")  # of machine.txt: what the table of plans shows


class Conditions(Part):
    """What was run, where, and why figures differ."""

    def introduction(self):
        self.add("# Results of the paper's benchmark")
        self.say("""This document compares the scores of racebeam's agents with published ones.
            `scripts/measure/paper_results.py` writes it from figures that `scripts/measure/plan_figures.py` gathered
            from the results of each plan; no figure is typed by hand. "The paper" is Bellemare et al. 2013.
            [paper-notes.md](paper-notes.md) says what racebeam does where the paper is silent.""")

    def conditions(self):
        self.add("## Commands, machine, versions")
        self.say("""The plans are part of the program. `scripts/measure/paper_plans FOLDER PLAN` runs a plan, verifies
            its rows, and gathers its figures. Times are seconds of processor time, so that other programs hardly change
            them. Rows, curves and digests of logs of long plans are kept in `docs/results/kept`. The same command on
            another machine continues a plan from there. The plans that are most worth continuing come first in this
            list: `learners`, `perturb`, `iw1`, `ram`, `searches` and `blob_prost`. Plans with other episodes, and
            samples, are in `docs/results/plans`.""")
        rows = []
        for name in (*PLANS, *(each for each in (*AGAIN, *SAMPLES) if each in self.figures)):
            found = self.figures.get(name)
            rows.append(
                [
                    self.title(name),
                    *(
                        [
                            f"{found['units']:,}" + (", goes on" if name in PLANS and found.get("unfinished") else ""),
                            f"{episodes(found):,}",
                            str(found["diverged"]),
                            number(found["seconds"] / 3600, 2),
                            *(found["machine"].get(key, "-") for key in MACHINE),
                        ]
                        if found
                        else ["not run yet", *["-"] * (3 + len(MACHINE))]
                    ),
                ]
            )
        self.add(rows_of(["plan", "units", "episodes", "trials that diverged", "core-hours", *MACHINE], *rows))
        self.old_perturb()

    def old_perturb(self):
        """Says that the tables do not show Perturb as it was."""
        found = self.figures.get("baselines", {})
        old = [games for agent, games in found.get("episodes", {}).items() if agent.startswith("perturb_")]
        if old and found["settings"]["perturb"]["frame_skip"] != 1 and "perturb" in self.figures:
            self.say(f"""The plan `baselines` includes {sum(sum(games.values()) for games in old):,} episodes of Perturb
                as it was, with one action for {found["settings"]["perturb"]["frame_skip"]} frames. No table of scores
                shows them; the scores of Perturb are those of the plan `perturb`.""")

    def scale(self):
        self.add("## What was scaled down")
        self.say("""The plan `paper` is the paper's whole benchmark, whose cost `racebeam experiment paper --dry-run`
            prints. The figures of this document are from smaller plans:""")
        iw1 = sum("iw1" in scores for scores in self.paper.values())
        games = {f"{agent}_games": self.games_of(agent) for agent in ("uct", "full_tree", "iw1")}
        header, *rows = SCALE
        self.add(rows_of(header, *([cell.format(iw1=iw1, **games) for cell in row] for row in rows)))

    def games_of(self, agent):
        """In how many games an agent has searched with its full budget."""
        found = [self.figures[plan]["searches"] for plan in FULL_SEARCHES if plan in self.figures]
        count = len({episode["game"] for each in found for episode in each if episode["agent"] == agent})
        return "1 game" if count == 1 else f"{count} games"

    def differences(self):
        self.add("## Why figures differ from the published ones")
        self.add(
            "\n".join(
                item_of_list(text)
                for text in (
                    """The emulator: the paper used the ALE of 2012. racebeam is bit-exact with ALE 0.12, whose
                    emulator and games' rules have changed since.""",
                    """Choices by score: where the paper is silent, scores in the training games decided some defaults
                    of the learners, such as DISCO's classes and LSH's bits. The paper's scores decided that Perturb
                    acts on each frame. Comparisons in these games therefore favour agreement, or higher scores. In the
                    50 testing games, no learner has been run yet.""",
                    """Starts: each episode begins at power-on with its own seed, without the human
                    trajectories and NOOPs that others used. If a game draws nothing from its seed, a deterministic
                    policy plays the same episode each time.""",
                    """Rewards: some rules differ. In Skiing, random play scored near 0 then, and about -17,000 now, so
                    its row cannot be compared.""",
                    self.single_episodes(),
                    """Single trials: a learner's score depends on the moment at which training ends
                    ([paper-notes.md](paper-notes.md#the-end-of-training)). The paper has the mean of 30 trials.""",
                    """Causes of single scores stand beside them: those of [baselines](#baselines), of
                    [learners](#learners-whole-training) and of [searches](#search). DISCO and LSH score more than in
                    the paper in all five games ([paper-notes.md](paper-notes.md#disco-and-lsh-above-the-paper)).""",
                    """Choices: the paper leaves much open ([paper-notes.md](paper-notes.md)).""",
                )
            )
        )

    def single_episodes(self):
        """How far the score of one episode can be trusted, by plans that have several of a kind."""
        ratios = []
        for found in self.figures.values():
            scores = {}
            for episode in found["searches"]:
                scores.setdefault((episode["agent"], episode["game"]), []).append(episode["score"])
            ratios += [max(each) / min(each) for each in scores.values() if len(each) > 1 and min(each) > 0]
        text = """Single episodes: a search has one episode in a game, whose score can be far from the mean of many. It
            does not show whether the published mean is reached."""
        if ratios:
            text += f""" Where UCT has two episodes of a kind, the higher score is {number(min(ratios), 2)} to
                {number(max(ratios), 2)} times the lower ([below](#uct-score-against-simulations))."""
        return f"""{text} In Ms. Pac-Man, the highest of six scores is twelve times the lowest
            ([paper-notes.md](paper-notes.md#ucts-kept-visits))."""

    def changes(self):
        rows = [
            [f"`{plan}`", agent, then]
            for plan, agent, is_now, then in CHANGED
            if (settings := self.figures.get(plan, {}).get("settings", {}).get(agent)) and not is_now(settings)
        ]
        if not rows:
            return
        self.add("## Agents that have changed since")
        self.say("""When the plans were run, these agents differed from those of their authors
            ([paper-notes.md](paper-notes.md)). They have been corrected, but this document still has their old figures.
            `racebeam experiment` computes new ones.""")
        self.add(rows_of(["plan", "agent", "what the agent did"], *rows))
