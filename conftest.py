"""All tests in Python share this. It finds the program and the modules of tests, and skips what cannot run.

HACKING.md, "Add a test", says how pytest is started.
"""

import contextlib
import importlib.util
import os
import pathlib
import platform
import shutil
import sys

import pytest

SOURCE = pathlib.Path(__file__).resolve().parent
SKIPPED = 77  # the exit status that ctest reads as "skipped"

os.environ.setdefault("RACEBEAM_BINARY", str(SOURCE / "build/release/racebeam"))
sys.path[:0] = [
    str(SOURCE / folder) for folder in ("tests/server", "tests/support", "scripts/measure", "scripts/measure/load")
]

import harness  # noqa: E402


def _has_module(name):
    return importlib.util.find_spec(name) is not None


def _missing_roms(games):
    return [f"an image of {game}" for game in games or ("pong",) if not harness.rom(game)]


def _missing_program():
    found = os.path.exists(harness.BINARY)
    return [] if found else [f"the program {harness.BINARY}, which scripts/build makes or RACEBEAM_BINARY names"]


# A marker, and what its arguments name that is not here.
NEEDS = {
    "needs_roms": _missing_roms,
    "needs_program": lambda _: _missing_program(),
    "needs_posix": lambda _: [] if os.name == "posix" and not harness.WINDOWS else ["POSIX"],
    "needs_glibc": lambda _: [] if platform.libc_ver()[0] == "glibc" else ["the GNU C library"],
    "needs_jax": lambda _: [] if _has_module("jax") else ["JAX"],
    "needs_modules": lambda names: [name for name in names if not _has_module(name)],
    "needs_programs": lambda names: [name for name in names if shutil.which(name) is None],
}


def pytest_collectstart(collector):
    """Lets a file import what is beside it, also if a file of another folder imported a module of the same name."""
    if isinstance(collector, pytest.Module):
        folder = collector.path.parent
        sys.path.insert(0, str(folder))
        for name in {path.stem for path in folder.glob("*.py")} & sys.modules.keys():
            if getattr(sys.modules[name], "__file__", None) != str(folder / f"{name}.py"):
                del sys.modules[name]


def pytest_runtest_setup(item):
    """Skips a test whose markers name something that is not here."""
    missing = [what for mark in item.iter_markers() if mark.name in NEEDS for what in NEEDS[mark.name](mark.args)]
    if missing:
        pytest.skip(f"not found: {', '.join(missing)}")


@pytest.fixture
def cleanup():
    """cleanup(FUNCTION, ARGUMENT...) has the function called at the end of the test. The last one is called first."""
    with contextlib.ExitStack() as stack:
        yield stack.callback


@pytest.fixture
def self_cleanup(request, cleanup):
    """Gives the class of the test `cleanup` as self.cleanup."""
    request.instance.cleanup = cleanup


@pytest.fixture
def self_subtests(request, subtests):
    """Gives the class of the test `subtests` as self.subtests."""
    request.instance.subtests = subtests


@pytest.fixture
def self_folder(request, tmp_path):
    """Gives the class of the test the path of an empty folder as self.folder."""
    request.instance.folder = str(tmp_path)


def pytest_make_parametrize_id(val, argname):
    """Long texts are named by their length."""
    return f"{argname}-of-{len(val)}" if isinstance(val, (str, bytes)) and len(val) > 60 else None


def _counts(config):
    """How many tests passed, failed and were skipped."""
    found = {kind: len(reports) for kind, reports in config.pluginmanager.get_plugin("terminalreporter").stats.items()}
    return found.get("passed", 0), found.get("failed", 0) + found.get("error", 0), found.get("skipped", 0)


@pytest.hookimpl(trylast=True)
def pytest_sessionfinish(session):
    """Sets the exit status to 77, which ctest reads as skipped, if every test was skipped."""
    passed, failed, skipped = _counts(session.config)
    if skipped and not passed and not failed:
        session.exitstatus = SKIPPED


def pytest_terminal_summary(terminalreporter):
    """Says after tests that failed what makes the program, if it is missing."""
    if _counts(terminalreporter.config)[1]:
        for what in _missing_program():
            terminalreporter.write_line(f"not found: {what}", red=True)


def pytest_addoption(parser):
    parser.addoption("--counts", action="store_true", help="end with a line that counts, as scripts of this tree do")


@pytest.hookimpl(trylast=True)
def pytest_unconfigure(config):
    if config.getoption("--counts"):
        print("{} passed, {} failed, {} skipped".format(*_counts(config)), flush=True)
