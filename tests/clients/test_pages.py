"""The page of a client: each program on it prints what the page says. The examples play.

A program is a block fenced with the language's name. A block fenced as `text` after it is what it prints; `...` stands
for any text within a line.
"""

import os
import pathlib
import re
import subprocess
import sys
import tempfile

import pytest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(SOURCE / "clients/conformance")]

from harness import BINARY, PATIENCE, Server  # noqa: E402

from clients import CLIENTS  # noqa: E402

BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.MULTILINE | re.DOTALL)

# The examples: file, arguments, a pattern of what they print.
EXAMPLES = {
    "shell": (),  # tests/clients/test_shell.py
    "js": (("clients/js/examples/many.mjs", (), r"scores (\d+ ?){8}\n"),),
    "cpp": (
        ("clients/cpp/examples/follow.cpp", (), r"scores( \d+){8}\n"),
        ("clients/cpp/examples/planner.cpp", ("10",), r"score \d+\n"),
    ),
    "lua": (
        ("clients/lua/examples/gap.lua", (), r"score \d+ in \d+ acts\n"),
        ("clients/lua/examples/follow.lua", (), r"score \d+, \d\.\d KiB of garbage a step; a screen has 32\.8 KiB\n"),
    ),
    "java": (
        ("clients/java/examples/Planner.java", ("10",), r"score \d+, \d+ frames run\n"),
        ("clients/java/examples/Sarsa.java", ("10",), r"episodes 1 to 10: mean score \d+\.\d\n"),
    ),
}

# Programs whose standard streams are those of a server. They tell the frame that they reached on standard error.
STDIO = {
    "java": """import racebeam.*;
               public class Stdio {
                 public static void main(String[] words) throws Exception {
                   try (Session game = Racebeam.connect("stdio")) {
                     game.load("beamfall");
                     game.observe("frame");
                     System.err.println(game.act("FIRE*7").number("frame"));
                   }
                 }
               }""",
    "cpp": """#include <iostream>
              #include <racebeam/client.hpp>
              int main() {
                auto game = racebeam::client::connect("stdio");
                game.load("beamfall");
                game.observe("frame");
                std::cerr << game.act("FIRE*7").number("frame") << std::endl;
              }""",
    "lua": """local game = require("racebeam").connect("stdio")
              game:load("beamfall")
              game:observe("frame")
              io.stderr:write(game:act("FIRE*7").frame, "\\n")
              game:close_connection()""",
    "js": """import { connect } from "racebeam";
             const game = await connect("stdio");
             await game.load("beamfall");
             await game.observe("frame");
             console.error((await game.act("FIRE*7")).frame);
             await game.disconnect();""",
    "shell": """source racebeam.bash
                racebeam_connect stdio
                racebeam_ask load beamfall
                racebeam_ask observe frame
                racebeam_ask act 'FIRE*7'
                racebeam_value frame >&2""",
}


def programs(text, language):
    """Pairs of a program and what it prints, if the page says so."""
    blocks = BLOCK.findall(text) + [("", "")]
    return [
        (body, after if kind == "text" else None)
        for (name, body), (kind, after) in zip(blocks, blocks[1:])
        if name == language
    ]


WITH_PAGES = ("java", "lua5.4", "luajit", "c++", "javascript", "bash")


@pytest.fixture(scope="module", params=WITH_PAGES)
def client(request):
    client = next(client for client in CLIENTS if client.name == request.param)
    if missing := client.missing():
        pytest.skip(f"not installed: {missing}")
    if client.build:
        subprocess.run(client.build, check=True)
    return client


class TestPage:
    @pytest.fixture(autouse=True)
    def keep_client(self, client):
        self.client = client

    client = CLIENTS[0]

    @pytest.fixture(autouse=True)
    def set_up(self, cleanup):
        self.server = Server("serve", "--listen", "tcp://127.0.0.1:0")
        cleanup(self.server.__exit__)
        self.environment = dict(
            os.environ,
            **dict(self.client.variables),
            RACEBEAM_ADDRESS=f"tcp://127.0.0.1:{self.server.port()}",
            RACEBEAM_PROGRAM=BINARY,
        )

    def write(self, folder, body):
        """The path of a new file with a program."""
        name = re.search(r"public class (\w+)", body)
        path = pathlib.Path(folder, (name[1] if name else "program") + pathlib.Path(self.client.runner[-1]).suffix)
        path.write_text(body)
        self.compile(path)
        (path.parent / "node_modules").mkdir()  # where Node looks for packages; others do not mind
        (path.parent / "node_modules/racebeam").symlink_to(SOURCE / "clients/js")
        return path

    def compile(self, program):
        if self.client.compiler:
            subprocess.run([*self.client.compiler, str(program)], check=True)

    def check(self, program, words, pattern):
        done = subprocess.run(
            [*self.client.runner[:-1], str(program), *words],
            env=self.environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            timeout=PATIENCE * 5,
        )
        assert done.returncode == 0, done.stdout
        assert re.search(f"\\A{pattern}\\Z", done.stdout)

    def test_its_programs_print_what_it_says(self, subtests):
        found = programs((SOURCE / self.client.page).read_text(), self.client.language)
        assert found
        for number, (body, expected) in enumerate(found):
            with subtests.test(program=number), tempfile.TemporaryDirectory() as folder:
                self.check(
                    self.write(folder, body),
                    (),
                    ".*" if expected is None else re.escape(expected).replace(r"\.\.\.", ".*"),
                )

    def test_its_standard_streams_can_be_those_of_a_server(self):
        with tempfile.TemporaryDirectory() as folder, Server("serve", "--stdio", streams=True) as server:
            path = self.write(folder, STDIO[self.client.language])
            done = subprocess.run(
                [*self.client.runner[:-1], str(path)],
                env=self.environment,
                stdin=server.process.stdout,
                stdout=server.process.stdin,
                stderr=subprocess.PIPE,
                text=True,
                timeout=PATIENCE * 5,
            )
            assert (done.returncode, done.stderr) == (0, "7\n")
            server.process.stdin.close()
            server.process.stdin = None
            assert server.wait() == 0

    def test_its_examples_play(self, subtests):
        for path, words, pattern in EXAMPLES[self.client.language]:
            with subtests.test(path=path):
                self.compile(SOURCE / path)
                self.check(SOURCE / path, words, pattern)
