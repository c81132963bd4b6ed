"""The sections of docs/results.md about the logs of episodes."""

from .learners import LEARNERS
from .parts import Part, episodes, number, rows_of, share_of_bench

VERIFICATION = (
    *("plan", "confirmed", "wrong", "not checked", "frames a second and core", "of the bench"),
    *("of the time of the run", "ALE agrees", "ALE does not"),
)


class Logs(Part):
    """Verification and size of logs."""

    def verification(self):
        self.add("## Verification")
        self.say("""`racebeam verify` replays each episode from its log, and confirms score, frames, end and state
            hashes. That proves that these actions give this score, but not which agent chose them
            ([episodes.md](episodes.md)). `scripts/check/verify-with-ale` replays the same logs in ALE. "Of the bench"
            is the speed of the verification, its start included, divided by that of `racebeam bench --screen none`
            for the same games, frames and frame skip.""")
        rows = [self.verification_row(name, found) for name, found in self.figures.items() if found["verified"]]
        if not rows:
            self.say("Not run yet.")
            return
        unverified = [self.title(name) for name, found in self.figures.items() if not found["verified"]]
        if unverified:
            self.say(f"Not verified yet: {'; '.join(unverified)}.")
        for name, found in self.figures.items():
            if found["verified"] and (more := found["verified"]["confirmed"] - episodes(found)) > 0:
                self.say(f"""The figures of {self.title(name)} include {more:,} rows that the tables no longer have,
                    because an agent was corrected and its units were run again.""")
        self.add(rows_of(VERIFICATION, *rows))
        self.bench_speeds()

    def verification_row(self, name, found):
        """The row of a plan that was verified, with the columns of VERIFICATION."""
        verified, ale = found["verified"], found["ale"] or {}
        if not any(ale.values()):
            ale = {}  # ALE played none of its games
        return [
            self.title(name),
            *(f"{verified[key]:,}" for key in ("confirmed", "wrong", "not_checked")),
            number(verified["frames"] / verified["seconds"], 0),
            share_of_bench(verified),
            number(100 * verified["seconds"] / found["seconds"], 1) + "%",
            *(f"{ale[key]:,}" if ale else "-" for key in ("agree", "differ")),
        ]

    def bench_speeds(self):
        """A paragraph for each processor: how fast the bench was there in each game."""
        speeds = {}
        for found in self.figures.values():
            speeds.setdefault(found["machine"].get("processor", "-"), {}).update(found["bench"]["none"])
        for processor, games in speeds.items():
            if games:
                self.say(
                    f"`racebeam bench --screen none --frame-skip 5` on {processor}, frames a second: "
                    + ", ".join(f"{game} {number(speed, 0)}" for game, speed in games.items())
                    + "."
                )

    def logs(self):
        self.add("## Logs")
        rows = []
        for name, agents, measure, goal in (
            ("baselines", ("random",), "largest", "at most 12,288"),
            ("hour", tuple(LEARNERS), "median", "under 2,048"),
        ):
            sizes = self.figures[name]["log_bytes"] if name in self.figures else {}
            rows += [
                [f"`{name}`", agent, measure, number(sizes[agent][measure], 0), goal]
                for agent in agents
                if agent in sizes
            ]
        if rows:
            self.add(rows_of(["plan", "agent", "size of", "bytes", "goal"], *rows))
        else:
            self.say("Not run yet.")
