"""Makes folders of results as `racebeam experiment` leaves them, and runs racebeam-evaluate."""

import contextlib
import io
import pathlib
import types

RESULTS = (
    "unit,game,image_md5,agent,trial,episode,environment_seed,agent_seed,score,frames,decisions,end,lives,state_hash,"
    "log_digest,version"
)
CURVES = "unit,game,agent,trial,episode,score,frames,decisions"


def result(game, agent, trial, episode, score, end="over", md5=None):
    """A line of results.csv."""
    return (
        f"{game}/{agent}/{trial},{game},{md5 or 'md5-of-' + game},{agent},{trial},{episode},"
        f"1,2,{score},1000,200,{end},0,00ff,11ee,0.1.0"
    )


def curve(game, agent, trial, episode, score, frames):
    """A line of curves.csv."""
    return f"{game}/{agent}/{trial},{game},{agent},{trial},{episode},{score},{frames},{frames // 5}"


def results_of(scores):
    """Lines of results.csv of {(agent, game): [scores of the episodes of each trial]}."""
    return [
        result(game, agent, trial, episode, score)
        for (agent, game), trials in scores.items()
        for trial, episodes in enumerate(trials)
        for episode, score in enumerate(episodes)
    ]


def write(folder, lines, curves=(), header=RESULTS):
    """Writes a folder of results, and returns its path."""
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "results.csv").write_text("\n".join([header, *lines, ""]))
    if curves:
        (folder / "curves.csv").write_text("\n".join([CURVES, *curves, ""]))
    return folder


def evaluate(*arguments):
    """Runs racebeam-evaluate, and returns its status, output and errors. Few repetitions of the bootstrap are enough
    here."""
    from racebeam_evaluation.main import main

    output, errors = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(output), contextlib.redirect_stderr(errors):
        try:
            status = main(["--repetitions", "50", *map(str, arguments)])
        except SystemExit as ended:  # a usage error
            status = ended.code
    return types.SimpleNamespace(returncode=status, stdout=output.getvalue(), stderr=errors.getvalue())


def report(*folders, mix=False):
    """The report on the results of `folders`. No figure is drawn."""
    from racebeam_evaluation.bootstrap import Bootstrap
    from racebeam_evaluation.load import read_all
    from racebeam_evaluation.reports.paper2013 import evaluate as report_of

    return report_of(read_all(list(folders), mix), Bootstrap(repetitions=50), mix)


def tables(*folders, mix=False):
    """The files of the tables that the results of `folders` give, by name."""
    from racebeam_evaluation.output.table import Table

    parts = report(*folders, mix=mix).parts
    return {name: text for part in parts if isinstance(part, Table) for name, text in part.files().items()}
