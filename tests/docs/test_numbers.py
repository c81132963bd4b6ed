"""Numbers in the documents are those of what they describe.

test_numbers.toml says of each section with numbers whether a script writes it, a test reads it, or why neither does.

    PYTHONPATH=scripts/measure .venv/bin/python tests/docs/test_numbers.py

prints how many numbers there are of each kind, and why some are left.
"""

import ast
import base64
import collections
import functools
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import zlib

import tomllib
from markdown import sections
from test_figures import last_run
from tree import ROOT

sys.path.insert(0, str(ROOT / "clients/conformance"))
import clients  # noqa: E402

BINARY = os.environ.get("RACEBEAM_BINARY", str(ROOT / "build/release/racebeam"))
BEAMFALL = b"8b96297bc95db74738674ce177f501c1"  # the MD5 of its image
NUMBER = re.compile(r"(?<![\w.$#/-])\d[\d,]*(?:\.\d+)?(?!\w)")
CODE_OR_ADDRESS = re.compile(r"`[^`]*`|\]\([^)]*\)")
MOST_WRONG = 0.03  # part of a count of lines, which changes with each change of a client
HEADINGS = {"Python": "python", "Java": "java", "Lua": "lua", "C++20,": "cpp", "JavaScript,": "js", "bash": "shell"}


def page(path):
    return (ROOT / path).read_text()


def table(text, heading):
    """The rows of the table with this heading, as lists of cells."""
    lines = text[text.index(heading) :].split("\n\n")[0].splitlines()[2:]
    return [[cell.strip() for cell in line.strip("| ").split("|")] for line in lines]


def numbers_of(lines):
    return sum(len(NUMBER.findall(CODE_OR_ADDRESS.sub("", line))) for line in lines)


def listed_sections():
    """Each section with numbers: its page, its heading, how many there are, and what test_numbers.toml says of it."""
    for name, listed in tomllib.loads(page("tests/docs/test_numbers.toml")).items():
        for section in sections(page(name)):
            if count := numbers_of(section.lines):
                yield name, section.heading, count, listed.get(section.heading, listed.get("*", ""))


class TestSections:
    def test_each_section_with_numbers_says_what_holds_them(self, subtests):
        for name, heading, _, holder in listed_sections():
            with subtests.test(page=name, section=heading):
                kind, _, rest = holder.partition(": ")
                assert kind in ("generated", "tested", "left"), "tests/docs/test_numbers.toml lacks the section"
                if kind != "left":
                    file, _, test = rest.partition(": ")
                    assert test in page(file)

    def test_each_page_is_there_and_each_listed_section_has_numbers(self):
        listed = tomllib.loads(page("tests/docs/test_numbers.toml"))
        pages = {path.relative_to(ROOT).as_posix() for path in (ROOT / "docs").rglob("*.md")}
        assert {name for name in pages if not name.startswith("docs/spec/")} - set(listed) == set()
        found = {(name, heading) for name, heading, *_ in listed_sections()}
        headings = {(name, heading) for name, held in listed.items() for heading in held if heading != "*"}
        assert headings - found == set()


class TestNumbers:
    def test_the_limits_of_a_server_have_their_defaults(self):
        output = subprocess.run([BINARY, "config"], capture_output=True, text=True, check=True).stdout
        defaults = dict(re.findall(r"(?m)^(\w+) = (\S+) +# default$", output))
        rows = table(page("server/README.md"), "| option | default | beyond the limit |")
        assert len(rows) == 13
        for name, default, _ in rows:
            if name != "`--max-memory`":
                key = name.strip("`-").replace("-", "_")
                assert re.match(r"\d+", default)[0] == defaults[key], name
        assert f"microseconds (default {defaults['busy_poll']})" in " ".join(page("server/README.md").split())

    def state(self, *words):
        """The bytes of an export, and a function that returns the bytes of the row that begins so in docs/states.md."""
        requests = ["load beamfall seed=1", "save a generator=1", " ".join(["export a", *words]), ""]
        output = subprocess.run([BINARY, "serve", "--stdio"], input="\n".join(requests).encode(), capture_output=True)
        data = base64.b64decode(output.stdout.splitlines()[-1].split(b"data=")[1])
        text = page("docs/states.md").partition("### States of vector environments")[2 if words else 0]
        rows = [row for row in table(text, "| offset | size | content |") if row[0].isdigit() and row[1].isdigit()]

        def part(content):
            [(at, size)] = [(int(at), int(size)) for at, size, name in rows if name.startswith(content)]
            return data[at : at + size]

        return data, part

    def test_an_export_has_the_bytes_of_the_table(self):
        number = functools.partial(int.from_bytes, byteorder="little")
        data, part = self.state()
        assert part("`RBSTATE`") == b"RBSTATE\n"
        version = re.search(r"kSnapshotVersion = (\d+)", page("environment/saved/saved_state_format.hpp"))[1]
        assert number(part("version")) == int(version)
        assert number(part("CRC-32")) == zlib.crc32(data[24:])
        assert (part("MD5"), part("the game's name").rstrip(b"\0")) == (BEAMFALL, b"beamfall")
        assert [number(part(name)) for name in ("rows", "1 if the generator", "size of the cart")] == [210, 1, 0]
        assert number(part("size of the whole")) == len(data)
        assert len(data) == 132 + number(part("size of the values")) + 2 * 160 * 210 + 2500
        slot, part = self.state("episode=1")
        assert part("`RBSLOT`") == b"RBSLOT\r\n"
        assert (number(part("size of the whole")), number(part("CRC-32"))) == (len(slot), zlib.crc32(slot[20:]))
        assert slot[-number(part("size of the machine's state")) :][:8] == b"RBSTATE\n"

    def test_a_log_has_the_bytes_of_the_table(self):
        requests = ["load beamfall max_episode_frames=600", "log inline", "reset", "act 1*700", "log last", ""]
        output = subprocess.run([BINARY, "serve", "--stdio"], input="\n".join(requests).encode(), capture_output=True)
        data = base64.b64decode(output.stdout.splitlines()[-1].split(b"data=")[1])
        rows = table(page("docs/episodes.md"), "| Offset | Bytes | Meaning |")
        magic, version, size, checksum = (data[int(at) :][: int(bytes)] for at, bytes, _ in rows[:4])
        sealed = data[int(rows[4][0]) :]
        assert (magic, int.from_bytes(version, "little")) == (b"RBEPISOD", 1)
        assert int.from_bytes(checksum, "little") == zlib.crc32(data[:20] + sealed)
        contents = zlib.decompress(sealed)
        assert int.from_bytes(size, "little") == len(contents)
        lines, _, rest = contents.partition(b"\n\n")
        assert [line.split()[0] for line in lines.splitlines()] == [b"load", b"image", b"from", b"ended"]
        decisions = int(re.search(rb" decisions=(\d+) ", lines)[1])
        assert decisions == 600
        assert (len(rest), rest[-decisions:]) == (8 * (decisions // 256 + 1) + decisions, b"\1" * decisions)

    def test_instructions_of_a_frame_are_those_of_the_baseline(self):
        counts = json.loads(page("tests/bench/instructions/baseline.json"))["translator"]
        rounded = {game: f"{round(counts[game], -3):,}" for game in ("seaquest", "pong")}
        text = " ".join(page("docs/performance.md").split())
        assert f"Seaquest takes {rounded['seaquest']} instructions a frame, and Pong {rounded['pong']} (" in text

    def test_the_results_are_what_their_script_writes(self):
        with tempfile.TemporaryDirectory() as folder:
            written = pathlib.Path(folder, "results.md")
            script = ROOT / "scripts/measure/paper_results.py"
            subprocess.run([sys.executable, "-B", script, "--into", written], check=True)
            assert written.read_text() == page("docs/results.md")

    def test_the_title_of_the_readme_rounds_the_speed_of_the_last_run(self):
        means, _, _ = last_run()
        [listed] = re.findall(r"\(ALE\), (\d+) times as\s+fast", page("README.md"))
        assert int(listed) == int(means["Screen of every frame"])

    def test_the_readme_names_the_packages_of_this_version(self):
        [version] = re.findall(r"project\(racebeam VERSION ([0-9.]+)", page("CMakeLists.txt"))
        versions = re.findall(r"racebeam-(\d+\.\d+\.\d+)", page("README.md"))
        assert set(versions) == {version}

    def test_clients_have_about_as_many_lines_as_their_page_says(self):
        lines = {client.language: client.lines_of_code() for client in clients.CLIENTS}
        rows = table(page("clients/README.md"), "| language | connects over |")
        assert len(rows) == len(HEADINGS)
        for name, *_, claim in rows:
            count = lines[HEADINGS[name.split()[0]]]
            assert abs(int(claim) - count) < MOST_WRONG * count, f"{name}: scripts/clients counts {count} lines"

    def test_the_python_page_names_the_extras_and_the_oldest_versions(self):
        project = tomllib.loads(page("pyproject.toml"))["project"]
        text = " ".join(page("docs/python/reference.md").split())
        [listed] = re.findall(r"Each of the extras (.*?) brings", text)
        assert set(re.findall(r"`([\w-]+)`", listed)) == set(project["optional-dependencies"])
        python = project["requires-python"].removeprefix(">=")
        assert f"runs on Linux with Python {python} or later" in text
        gymnasium = re.search(r"gymnasium>=([\d.]+)", project["optional-dependencies"]["gymnasium"][0])[1]
        assert f"brings Gymnasium {gymnasium} or later" in text

    def test_the_python_page_has_the_limits_of_vectors(self):
        source = ast.parse(page("clients/python/racebeam/vector_options.py"))
        [limits] = (
            node.value
            for node in source.body
            if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "INTEGERS"
        )
        limits = {key.value: ast.unparse(value) for key, value in zip(limits.keys, limits.values)}
        figures = {
            name.strip("`"): takes for name, takes in table(page("docs/python/reference.md"), "| argument | takes |")
        }
        for name in ("stack_num", "noop_max", "frameskip"):
            assert figures[name].replace(" to ", ", ") == limits[name].strip("()")


def print_counts():
    kinds, reasons = collections.Counter(), collections.Counter()
    for _, _, count, holder in listed_sections():
        kind, _, reason = holder.partition(": ")
        kinds[kind] += count
        if kind == "left":
            reasons[reason] += count
    for name, count in (*kinds.most_common(), *reasons.most_common()):
        print(f"{count:>6}  {'left: ' if name in reasons else ''}{name}")


if __name__ == "__main__":
    print_counts()
