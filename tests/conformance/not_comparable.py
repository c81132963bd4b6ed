"""What cannot be compared with the reference, and why. The plan leaves it out of a run, and the report
counts it.

The findings are in docs/spec/environment.md, 5, docs/spec/games/README.md and docs/spec/palette.md.
"""

from dataclasses import dataclass, replace


@dataclass(frozen=True)
class Gap:
    games: tuple
    key: str  # the field of Run that is reset to 0
    reason: str


NOT_COMPARABLE = (
    Gap(
        ("video_cube",),
        "limit",
        "its mode program acts until the cube is turned; once the limit of frames is "
        "reached, acts are refused and the reference never comes back",
    ),
    Gap(
        ("atlantis2",),
        "lifeloss",
        "the lives that the reference compares with are uninitialised: it ends episodes differently from run to run",
    ),
)


def comparable(run):
    """Returns the run without what cannot be compared in it, and the gaps that this leaves."""
    gaps = [gap for gap in NOT_COMPARABLE if run.game in gap.games and getattr(run, gap.key)]
    for gap in gaps:
        run = replace(run, **{gap.key: 0})
    return run, gaps
