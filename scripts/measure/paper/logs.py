"""The sections of docs/results.md about the logs of episodes."""

from .learners import LEARNERS
from .parts import SAMPLES, Part, episodes, number, rows_of, share_of_bench

VERIFICATION = (
    *("plan", "episodes", "confirmed", "wrong", "not checked", "ALE agrees", "ALE does not", "not played in ALE"),
    *("frames a second and core", "of the bench", "of the time of the run"),
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
        self.say("""Rows of units that were run again, because an agent was corrected, are not counted: a digest of the
            rows of each unit tells whether they are those that were checked. Of
            `baselines`, ALE has played the logs of the five training games. Of samples and of other episodes, it has
            played the first three episodes of each unit. Of `perturb`, it has played only those of the sample.""")
        unverified = [self.title(name) for name, found in self.figures.items() if not found["verified"]]
        if unverified:
            self.say(f"Not verified yet: {'; '.join(unverified)}.")
        for name, found in self.figures.items():
            if units := (found.get("checked") or {}).get("unplayed"):
                self.say(f"""ALE has not played these units of {self.title(name)}, whose logs were not kept:
                    {", ".join(f"`{unit}`" for unit in units)}.""")
        for sample, plan in SAMPLES.items():
            if sample in self.figures and plan in self.figures:
                self.say(self.same_again(sample, plan))
        if differ := (self.figures.get("const-again", {}).get("ale") or {}).get("differ"):
            self.say(f"""ALE does not agree with {differ} episodes of Const in Berzerk that begin with no-ops. A reset
                of Berzerk chooses the mode by actions that take the frame skip
                ([environment.md](spec/environment.md)). For no-ops of one frame, the script sets a frame skip of 1, so
                that its reset is shorter. Without no-ops, 36 episodes of Const in Berzerk agree.""")
        self.add(rows_of(VERIFICATION, *rows))
        self.bench_speeds()

    def same_again(self, sample, plan):
        """A sentence that says whether the units of a sample score what those of its plan did."""
        scores = self.figures[plan]["scores"]
        means = [
            mean == scores.get(agent, {}).get(game)
            for agent, games in self.figures[sample]["scores"].items()
            for game, mean in games.items()
        ]
        return f"""{len(means)} of the {self.figures[plan]["units"]:,} units of {self.title(plan)} were run again, for
            ALE to play their logs. The means of {sum(means)} of them are those of the first run."""

    def verification_row(self, name, found):
        """The row of a plan that was verified, with the columns of VERIFICATION."""
        verified, ale = found["verified"], found["ale"] or {}
        every = episodes(found)
        checked = found.get("checked") or {"verify": verified["confirmed"], "ale": ale.get("agree", 0)}
        differ = ale.get("differ", 0)
        share = min(every / verified["confirmed"], 1)  # of the time: some rows have been run again since
        return [
            self.title(name),
            *(f"{count:,}" for count in (every, checked["verify"], verified["wrong"], verified["not_checked"])),
            *(f"{count:,}" for count in (checked["ale"], differ, max(every - checked["ale"] - differ, 0))),
            number(verified["frames"] / verified["seconds"], 0),
            share_of_bench(verified),
            number(100 * verified["seconds"] * share / found["seconds"], 1) + "%",
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
