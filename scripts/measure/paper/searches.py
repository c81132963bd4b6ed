"""The sections of docs/results.md about searches."""

import statistics

from .parts import FULL_SEARCHES, Part, agreement, known_cause, number, rows_of

SEARCH_GOALS = {("uct", "boxing"): 95, ("uct", "asterix"): 100000, ("uct", "seaquest"): 2500}
SIMULATIONS = {10: "uct10", 50: "uct50", 150: "uct150", 500: "uct"}

SEARCHES = (
    *("agent", "game", "score", "published", "agrees", "goal", "decisions"),
    *("seconds a decision", "frames a second", "of the bench", "cause"),
)


def seconds_a_decision(episode):
    return episode["seconds"] / episode["decisions"]


def cause(agent, game, score, published):
    """Why a score is more than a fifth from the published one."""
    if published is None or abs(score - published) <= abs(published) / 5:
        return "-"
    return known_cause(game, agent) or "unknown"


class Searches(Part):
    """Scores of agents that search, and their speed."""

    def searches(self):
        self.add("## Search")
        plans = [plan for plan in FULL_SEARCHES if not self.lacks(plan)]
        every = self.different_episodes(plans)
        if every:
            self.say("""Each row is one episode, at the full budget of a decision. The published scores of UCT and of
                the full tree are means of 10 episodes, from which one episode can differ by chance. "Of the bench"
                compares the speed with that of `racebeam bench --search --frame-skip 5`. The last column has the cause
                of a score that is more than a fifth from the published one, by `causes.csv` in
                `evaluation/racebeam_evaluation/data`. An episode that two plans have is shown once.""")
            self.add(rows_of(SEARCHES, *(self.search_row(*each) for each in every)))
        seconds_of_uct = [seconds_a_decision(episode) for _, episode in every if episode["agent"] == "uct"]
        if seconds_of_uct:
            self.say(f"""UCT takes {number(statistics.mean(seconds_of_uct), 2)} seconds a decision, the mean of these
                games (goal: at most 1). The paper says that a decision of its searches took about 15 seconds.""")

    def search_row(self, found, episode):
        """The row of an episode of a plan, with the columns of SEARCHES."""
        agent, game, score = episode["agent"], episode["game"], episode["score"]
        published = self.paper.get(game, {}).get(agent)
        speed, bench = episode["searched_frames"] / episode["seconds"], found["bench"]["search"].get(game)
        return [
            agent,
            game,
            number(score),
            number(published),
            agreement([score], published, "episode"),
            number(SEARCH_GOALS.get((agent, game)), 0),
            f"{episode['decisions']:,}",
            f"{seconds_a_decision(episode):.2g}",
            number(speed, 0),
            number(speed / bench, 2) if bench else "-",
            cause(agent, game, score, published),
        ]

    def different_episodes(self, plans):
        """(figures of its plan, episode) of each, without those that an earlier plan has: seeds follow from the names
        of agent and game, so that plans repeat episodes."""
        every = {}
        for plan in plans:
            for episode in self.figures[plan]["searches"]:
                key = tuple(episode[name] for name in ("agent", "game", "score", "decisions"))
                every.setdefault(key, (self.figures[plan], episode))
        return list(every.values())

    def simulations(self):
        self.add("## UCT: score against simulations")
        if self.lacks(*(name for name in SIMULATIONS.values() if name != "uct")) or "uct" not in self.figures:
            return
        self.say("The table has the mean score of the episodes, and their number in brackets.")
        each = {count: self.figures[name] for count, name in SIMULATIONS.items()}
        games = each[10]["games"]
        self.add(
            rows_of(
                ["game", *(f"{count} simulations" for count in each)],
                *(
                    [
                        game,
                        *(
                            f"{number(found['scores']['uct'].get(game))} ({found['episodes']['uct'].get(game, 0)})"
                            for found in each.values()
                        ),
                    ]
                    for game in games
                ),
            )
        )
