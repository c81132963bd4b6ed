"""The clients that hold the conformance conversation. A new client is a row of the table below."""

import ast
import dataclasses
import os
import pathlib
import shutil
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]
HERE = pathlib.Path(__file__).resolve().parent
BUILT = ROOT / "build/clients"

EVERY_WAY = frozenset({"unix", "pipes", "file", "announce", "launch", "tls"})
EVERYTHING = EVERY_WAY | {"raw"}


@dataclasses.dataclass(frozen=True)
class Client:
    name: str
    language: str  # as on its page, in fences
    runner: tuple[str, ...]  # a command and the program that takes a file of steps
    sources: str  # a pattern: the files of the client
    offers: frozenset = EVERY_WAY  # beside TCP, as in `section ... needs WHAT...`
    build: tuple[str, ...] = ()  # a command
    compiler: tuple[str, ...] = ()  # a command that takes a program, so that the runner need not compile it
    probe: tuple[str, ...] = ()  # a command that succeeds where the runner has what it needs
    variables: tuple[tuple[str, str], ...] = ()

    def missing(self):
        """What is not installed here, or None."""
        absent = next((word for word in (self.runner[0], *self.build[:1]) if shutil.which(word) is None), None)
        if absent is None and self.probe and subprocess.run(self.probe, capture_output=True).returncode != 0:
            return f"success of {' '.join(self.probe)}"
        return absent

    @property
    def page(self):
        return f"clients/{self.language}/README.md"

    def lines_of_code(self):
        """Lines of the client that are neither empty nor comments nor docstrings."""
        texts = [path.read_text() for path in ROOT.glob(self.sources)]
        lines = sum(
            1 for text in texts for line in text.splitlines() if line.strip() and not line.strip().startswith(COMMENTS)
        )
        return lines - (docstring_lines(*texts) if self.language == "python" else 0)


def docstring_lines(text):
    """Lines of the docstrings of a Python source that are not empty."""
    strings = [
        node.body[0].value
        for node in ast.walk(ast.parse(text))
        if isinstance(node, DOCUMENTED) and ast.get_docstring(node) is not None
    ]
    lines = text.splitlines()
    return sum(1 for string in strings for line in lines[string.lineno - 1 : string.end_lineno] if line.strip())


DOCUMENTED = (ast.Module, ast.ClassDef, ast.FunctionDef)
COMMENTS = ("//", "/*", "*", "#", "--")

CLIENTS = (
    Client(
        "python",
        "python",
        ("python3", "-B", str(HERE / "runner.py")),
        "clients/python/single_file/client.py",
        offers=EVERYTHING,
    ),
    Client(
        "java",
        "java",
        ("java", "-cp", str(BUILT / "java"), str(HERE / "Runner.java")),
        "clients/java/src/main/java/racebeam/*.java",
        offers=EVERYTHING,
        build=(
            "javac",
            "-Xlint:all",
            "-d",
            str(BUILT / "java"),
            *map(str, ROOT.glob("clients/java/src/main/java/**/*.java")),
        ),
    ),
    *(
        Client(
            program,
            "lua",
            (program, str(HERE / "runner.lua")),
            "clients/lua/racebeam/*.lua",
            offers=EVERYTHING,
            probe=(program, "-e", "require 'socket' require 'ssl'"),
            variables=(("LUA_PATH", f"{ROOT}/clients/lua/?.lua;{ROOT}/clients/lua/?/init.lua;;"),),
        )
        for program in ("lua5.1", "lua5.4", "luajit")
    ),
    Client(
        "c++",
        "cpp",
        ("python3", "-B", str(HERE / "run_cpp.py"), str(HERE / "runner.cpp")),
        "clients/cpp/racebeam/**/*.hpp",
        build=("python3", "-B", str(HERE / "run_cpp.py"), "--build", str(HERE / "runner.cpp")),
        offers=EVERYTHING,
        compiler=("python3", "-B", str(HERE / "run_cpp.py"), "--build"),
        probe=("python3", "-B", str(HERE / "run_cpp.py"), "--probe"),
    ),
    Client("javascript", "js", ("node", str(HERE / "runner.mjs")), "clients/js/src/**/*.js", offers=EVERYTHING),
    Client(
        "bash",
        "shell",
        ("bash", str(HERE / "runner.bash")),
        "clients/shell/racebeam.bash",
        offers=frozenset({"pipes", "file", "announce", "launch"}),
        variables=(("PATH", f"{ROOT}/clients/shell:{os.environ['PATH']}"),),
    ),
)
