"""An experiment of half a minute, which schedulers run in parts, and its results, which must not depend on that."""

PLAN = """games = ["beamfall"]
agents = ["random", "const", "basic"]
trials = 2
training_episodes = 4
evaluation_episodes = 2
background_screens = 500
environment = "max_episode_frames=1000"
"""


def files(folder):
    """The contents of all files of results by their paths, without times."""
    return {
        path.relative_to(folder).as_posix(): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file() and "times" not in path.name
    }
