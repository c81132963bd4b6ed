"""The sections of docs/results.md about searches."""

import statistics

from .parts import Part, agreement, number, rows_of

SEARCH_GOALS = {("uct", "boxing"): 95, ("uct", "asterix"): 100000, ("uct", "seaquest"): 2500}
SIMULATIONS = {10: "uct10", 50: "uct50", 150: "uct150", 500: "uct"}


class Searches(Part):
    """Scores of agents that search, and their speed."""

    def searches(self):
        self.add("## Search")
        rows = []
        seconds_of_uct = []
        for plan in ("uct", "full_tree", "iw1", "searches"):
            if self.lacks(plan):
                continue
            found = self.figures[plan]
            for episode in found["searches"]:
                name = episode["agent"]
                game, score = episode["game"], episode["score"]
                seconds = episode["seconds"] / episode["decisions"]
                if name == "uct":
                    seconds_of_uct.append(seconds)
                speed = episode["searched_frames"] / episode["seconds"]
                bench = found["bench"]["search"].get(game)
                rows.append(
                    [
                        name,
                        game,
                        number(score),
                        number(self.paper.get(game, {}).get(name)),
                        agreement([score], self.paper.get(game, {}).get(name), "episode"),
                        number(SEARCH_GOALS.get((name, game)), 0),
                        f"{episode['decisions']:,}",
                        number(seconds, 2),
                        number(speed, 0),
                        number(speed / bench, 2) if bench else "-",
                    ]
                )
        if rows:
            self.say("""One episode each, at the full budget of a decision. The last column compares with
                `racebeam bench --search --frame-skip 5`.""")
            self.add(
                rows_of(
                    [
                        "agent",
                        "game",
                        "score",
                        "published",
                        "agrees",
                        "goal",
                        "decisions",
                        "seconds a decision",
                        "frames a second",
                        "of the bench",
                    ],
                    *rows,
                )
            )
        if seconds_of_uct:
            self.say(f"""UCT takes {number(statistics.mean(seconds_of_uct), 2)} seconds a decision in the mean (goal:
            at most 1; the paper's
                took 15).""")

    def simulations(self):
        self.add("## UCT: score against simulations")
        if self.lacks(*(name for name in SIMULATIONS.values() if name != "uct")) or "uct" not in self.figures:
            return
        self.say("Means of the episodes, whose number is in brackets.")
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
