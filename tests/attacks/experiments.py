"""Attacks on experiments and on files that are written: two at a time, kills, clocks, absurd plans, full disks."""

import collections
import pathlib
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from attack import BINARY, PATIENCE, Lacking, attack, fault_of_end, files_in, run, small_disk

PLAN = """games = ["beamfall", "updraft"]
agents = ["random", "basic", "uct"]
trials = 1
training_episodes = 2
evaluation_episodes = 2
background_screens = 50
environment = "max_episode_frames=60 sticky=0.25"
[agent.uct]
training_episodes = 0
evaluation_episodes = 1
simulations = 1
"""
ONE_GAME = PLAN.replace('"beamfall", "updraft"', '"beamfall"')
OPTIONS = ("--checkpoint-seconds", "0", "--threads", "1")


def results_in(folder):
    """The files of results, without times."""
    return {path: data for path, data in files_in(folder).items() if "times" not in path}


def write_plan(place, plan=PLAN):
    (place / "plan.toml").write_text(plan)
    return place / "plan.toml"


def whole_results(place, plan=PLAN):
    """The results of an experiment that is left alone."""
    status, _, errors = run("experiment", write_plan(place, plan), "--into", place / "whole", *OPTIONS)
    assert status == 0, errors
    return results_in(place / "whole")


def fault_of_results(folder, expected, *options, **environment):
    """Continues the experiment in a folder. Returns a fault unless it ends with the results of an undisturbed one."""
    plan = folder.parent / "plan.toml"
    status, _, errors = run("experiment", plan, "--into", folder, *(options or OPTIONS), **environment)
    if status != 0:
        return f"it does not go on: {errors[-300:]}"
    found = results_in(folder)
    differing = sorted(path for path in expected.keys() | found.keys() if expected.get(path) != found.get(path))
    return f"other files than without the attack: {differing[:5]}" if differing else ""


@attack(times=10)
def two_on_one_folder(chance, times):
    """Two or three processes run one plan into one folder at the same time, and one of them may be killed."""
    with tempfile.TemporaryDirectory() as name:
        place = pathlib.Path(name)
        expected = whole_results(place)
        for number in range(times):
            folder = place / f"shared-{number}"
            command = [BINARY, "experiment", place / "plan.toml", "--into", folder, *OPTIONS]
            running = [
                subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
                for _ in range(chance.randrange(2, 4))
            ]
            victim = running[0] if chance.random() < 0.5 else None
            if victim:
                time.sleep(chance.uniform(0, 1))
                victim.kill()
            for process in running:
                _, errors = process.communicate(timeout=PATIENCE)
                yield fault_of_end(process.returncode, errors, (0, 1, -signal.SIGKILL) if process is victim else (0, 1))
            yield fault_of_results(folder, expected)


# The calls by which an experiment changes files.
CHANGES = ("flock", "mkdir", "openat", "pwrite64", "write", "fchmod", "rename", "unlink", "rmdir")


def traced(place, folder, *options):
    """Runs the experiment under strace. Returns the status, and the text on standard error."""
    command = ["strace", "-f", "--seccomp-bpf", "-o", place / "calls", *options, BINARY]
    try:
        done = subprocess.run(
            [*command, "experiment", place / "plan.toml", "--into", folder, *OPTIONS],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            text=True,
            timeout=PATIENCE,
        )
    except FileNotFoundError:
        raise Lacking("strace is missing") from None
    return done.returncode, done.stderr


def changes_of(place, names):
    """Pairs of a call and its number among those of its name: the calls after the first that names the results."""
    status, errors = traced(place, place / "traced", "-e", "trace=" + ",".join(names))
    if status != 0:
        raise Lacking(f"strace does not work here: {errors[-200:]}")
    shutil.rmtree(place / "traced")
    found, counts, has_begun = [], collections.Counter(), False
    for name, words in re.findall(r"(?m)^\d+ +(\w+)\((.*)", (place / "calls").read_text()):
        counts[name] += 1
        has_begun = has_begun or "/traced" in words
        if has_begun and "O_RDONLY" not in words:
            found.append((name, counts[name]))
    return found


def few(chance, times, found):
    """`times` of the elements, in their order; 0: all."""
    return sorted(chance.sample(range(len(found)), min(times, len(found)))) if times else range(len(found))


@attack(times=0)
def kills_at_each_change(chance, times):
    """The experiment is killed at one call by which it changes a file: at each of them, or at as many as --times."""
    with tempfile.TemporaryDirectory() as name:
        place = pathlib.Path(name)
        expected = whole_results(place, ONE_GAME)
        found = changes_of(place, CHANGES)
        for index in few(chance, times, found):
            call, number = found[index]
            folder = place / "killed"
            status, errors = traced(place, folder, "-e", f"inject={call}:signal=KILL:when={number}")
            yield fault_of_end(status, errors, (-signal.SIGKILL,))
            fault = fault_of_results(folder, expected)
            yield f"after a kill at {call} {number}: {fault}" if fault else ""
            shutil.rmtree(folder)


@attack(times=0)
def failures_of_each_change(chance, times):
    """One call fails, then each of its name from there on: the disk is full, or broken. The experiment ends with a
    sentence. When the disk is as before, it goes on, and ends with the results of an undisturbed one."""
    with tempfile.TemporaryDirectory() as name:
        place = pathlib.Path(name)
        expected = whole_results(place, ONE_GAME)
        found = [call for call in changes_of(place, CHANGES) if call[0] in ("mkdir", "openat", "pwrite64", "rename")]
        for index in few(chance, times, found):
            call, number = found[index]
            for error, when in (("ENOSPC", f"{number}"), ("ENOSPC", f"{number}+"), ("EIO", f"{number}")):
                folder = place / "failed"
                status, errors = traced(place, folder, "-e", f"inject={call}:error={error}:when={when}")
                yield fault_of_end(status, errors, (0, 1))
                yield f"status 1 without a sentence: {errors!r}" if status == 1 and "racebeam: " not in errors else ""
                fault = fault_of_results(folder, expected)
                yield f"after {error} of {call} {when}: {fault}" if fault else ""
                shutil.rmtree(folder)


AGENTS = """games = ["beamfall"]
agents = ["bass", "disco", "blob_prost", "uct", "iw1", "rollout_iw1", "full_tree"]
trials = 1
training_episodes = 6
evaluation_episodes = 3
background_screens = 100
class_screens = 100
environment = "max_episode_frames=200 sticky=0.25"
""" + "".join(
    f"[agent.{agent}]\ntraining_episodes = 0\n{setting}\n"
    for agent, setting in (
        ("uct", "simulations = 2"),
        ("iw1", "frames = 60"),
        ("rollout_iw1", "frames = 60"),
        ("full_tree", "frames = 60"),
    )
)


@attack(times=20)
def kills_at_random_moments(chance, times):
    """One experiment of many agents is killed and goes on. The last run has the interpreter, two threads, and the plain
    fallback of SIMD. Checkpoints are written at the end of each episode."""
    with tempfile.TemporaryDirectory() as name:
        place = pathlib.Path(name)
        start = time.monotonic()
        expected = whole_results(place, AGENTS)
        whole = time.monotonic() - start
        command = [BINARY, "experiment", place / "plan.toml", "--into", place / "parts", *OPTIONS]
        for _ in range(times):
            process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
            time.sleep(chance.uniform(0, 2 * whole / times))
            process.kill()
            _, errors = process.communicate()
            yield fault_of_end(process.returncode, errors, (0, -signal.SIGKILL))
        other = ("--threads", "2", "--cpu", "interpreter")
        yield fault_of_results(place / "parts", expected, *other, RACEBEAM_SIMD="plain")


@attack(times=6)
def clock_set_back(chance, times):
    """A run is killed and goes on in another year, before or after; times are those of other clocks."""
    if not shutil.which("faketime"):
        raise Lacking("faketime is missing")
    with tempfile.TemporaryDirectory() as name:
        place = pathlib.Path(name)
        expected = whole_results(place)
        for number in range(times):
            folder = place / f"clock-{number}"
            for date in chance.sample(["1971-01-01", "1999-12-31 23:59:59", "2037-01-01", "-10y", "+3d"], 3):
                command = [
                    "faketime",
                    "-f",
                    date,
                    BINARY,
                    "experiment",
                    place / "plan.toml",
                    "--into",
                    folder,
                    *OPTIONS,
                ]
                if not date.startswith(("-", "+")):
                    command.remove("-f")
                process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
                try:
                    _, errors = process.communicate(timeout=chance.uniform(0.1, 1))
                except subprocess.TimeoutExpired:
                    process.terminate()
                    _, errors = process.communicate()
                yield fault_of_end(process.returncode, errors, (0, 1, 130, 143, -15))
            yield fault_of_results(folder, expected)


ABSURD = [
    "",
    "\0",
    "games = []",
    'games = ["beamfall"]',
    'games = ["beamfall"]\nagents = []',
    'games = ["beamfall"]\nagents = ["random"]\ntrials = 0',
    'games = ["beamfall"]\nagents = ["random"]\ntrials = -1',
    'games = ["beamfall"]\nagents = ["random"]\ntrials = 99999999999999999999',
    'games = ["beamfall"]\nagents = ["random"]\ntrials = 1e400',
    'games = ["beamfall"]\nagents = ["random"]\nevaluation_episodes = 2147483647',
    'games = ["beamfall", "beamfall"]\nagents = ["random"]',
    'games = ["beamfall"]\nagents = ["random", "random"]',
    'games = ["../../etc"]\nagents = ["random"]',
    'games = ["beamfall"]\nagents = ["../x"]',
    'name = "../../x"\ngames = ["beamfall"]\nagents = ["random"]',
    'games = ["beamfall"]\nagents = ["blob_prost"]\n[agent.blob_prost]\nmost_features = 1e300',
    'games = ["beamfall"]\nagents = ["lsh"]\n[agent.lsh]\nvectors = 65535\nones = 100000\nbuckets = 20000',
    'games = ["beamfall"]\nagents = ["basic"]\n[agent.basic]\nalpha = nan',
    'games = ["beamfall"]\nagents = ["random"]\nenvironment = "frame_skip=0"',
    'games = ["beamfall"]\nagents = ["random"]\nenvironment = "seed=1"',
    'games = ["beamfall"]\nagents = ["random"]\nenvironment = "max_episode_frames=0"\nevaluation_episodes = 1000000',
    'games = ["beamfall"]\nagents = ["random"]\nbackground_screens = 2147483647',
    "[" * 100_000,
    "a." * 50_000 + "b = 1",
    'games = ["' + "x" * 500_000 + '"]',
    "x = 1\n" * 100_000,
    'games = "beamfall"\nagents = 7',
    "\xff\xfe",
]


def status_of_two_seconds(plan):
    """Runs a plan for two seconds, in two GiB. Returns the status, and the text on standard error."""
    process = subprocess.Popen(
        [BINARY, "experiment", plan, "--into", plan.parent / "results"],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_AS, (2 << 30, 2 << 30)),
    )
    try:
        _, errors = process.communicate(timeout=2)
    except subprocess.TimeoutExpired:
        process.terminate()
        _, errors = process.communicate(timeout=PATIENCE)
    return process.returncode, errors


@attack(times=1)
def absurd_plans(chance, times):
    """Plans that make no sense, or ask for more than there is. A dry run says what is wrong, or what it costs. A run
    is refused, or plays until a signal ends it."""
    with tempfile.TemporaryDirectory() as name:
        plan = pathlib.Path(name) / "plan.toml"
        for _ in range(times):
            for text in ABSURD:
                plan.write_text(text, encoding="latin-1")
                status, _, errors = run("experiment", plan, "--dry-run", "--unmeasured", timeout=PATIENCE)
                yield fault_of_end(status, errors)
                left = [path.name for path in plan.parent.iterdir()]
                yield "" if left == ["plan.toml"] else f"a dry run leaves {left}"
                yield fault_of_end(*status_of_two_seconds(plan), (0, 1, 2, -signal.SIGTERM))
                shutil.rmtree(plan.parent / "results", ignore_errors=True)


def fill(disk, pages):
    """Fills the disk until `pages` pages are free."""
    with open(disk / "filler", "wb", buffering=0) as filler:
        try:
            while True:
                filler.write(b"\0" * 4096)
        except OSError:
            pass
        filler.truncate(max(0, filler.tell() // 4096 - pages) * 4096)


@attack(times=40)
def full_disk_of_an_experiment(chance, times):
    """The disk is full after a number of pages, one more in each run, so that each write fails in some run. When there
    is room again, the experiment goes on, and ends with the results of an undisturbed one."""
    with tempfile.TemporaryDirectory() as name:
        expected = whole_results(pathlib.Path(name))
    for pages in range(times):
        with small_disk(1000) as disk:
            plan = write_plan(disk)
            fill(disk, pages)
            status, _, errors = run("experiment", plan, "--into", disk / "results", *OPTIONS)
            yield fault_of_end(status, errors, (0, 1))
            (disk / "filler").unlink()
            yield fault_of_results(disk / "results", expected)


TALK = b"load beamfall seed=1\nrecord %s film\nact 1*60\nact 3*60\nrecord stop\nquit\n"


@attack(times=30)
def full_disk_of_a_film(chance, times):
    """Recordings, rendered films, pictures, and the files that announce a server. A failure leaves no file behind."""
    with tempfile.TemporaryDirectory() as name:
        whole_results(pathlib.Path(name))
        log = next(pathlib.Path(name).glob("whole/logs/*/1.episode"))
        for pages in range(times):
            with small_disk(300) as disk:
                fill(disk, pages)
                for kind in (b"png", b"gif", b"y4m", b"wav"):
                    records = disk / kind.decode()
                    records.mkdir()
                    status, output, errors = run("serve", "--stdio", "--record-dir", records, data=TALK % kind)
                    yield fault_of_end(status, errors, (0, 1))
                    hidden = [path.name for path in disk.rglob(".*")]
                    yield f"the recording leaves {hidden}" if hidden else ""
                    shutil.rmtree(records, ignore_errors=True)
                for film in ("film.gif", "film.y4m", "film.wav", "pictures"):
                    status, _, errors = run("render", log, "--to", disk / film)
                    yield fault_of_end(status, errors, (0, 1))
                    left = [path.name for path in disk.iterdir() if path.name != "filler"]
                    yield f"a film that failed leaves {left}" if status and left else ""
                    subprocess.run(["rm", "-rf", *(disk / path for path in left)], check=True)
                for option in ("--ready-file", "--announce"):
                    address = "tcp://127.0.0.1:0"
                    words = ["serve", "--listen", address, "--until-idle", "1", option, disk / "file", "--grace", "0"]
                    status, _, errors = run(*words)
                    yield fault_of_end(status, errors, (0, 1))
                    left = [path.name for path in disk.iterdir() if path.name != "filler"]
                    yield f"{option} leaves {left}" if left else ""
