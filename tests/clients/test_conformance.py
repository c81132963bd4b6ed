"""The comparison of clients finds what differs, and what the conversation leaves out."""

import pathlib
import re
import sys

import pytest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(SOURCE / "clients/conformance")]

import comparison  # noqa: E402
import coverage  # noqa: E402
from harness import BINARY  # noqa: E402

import clients  # noqa: E402

FILES = ("conversation.txt", "faults.txt")


def printed_by(names):
    """Lines as a client prints them, a line for each section."""
    return [line for name in names for line in (f"section {name}", "connected")]


class TestComparison:
    @pytest.fixture(autouse=True)
    def set_up(self):
        paired = {name for pair in comparison.alike(FILES) for name in pair}
        names = comparison.section_names(FILES, clients.EVERYTHING)
        # The tests change the first section, and leave out the last. A section of a pair would count twice.
        self.output = printed_by(sorted(names - paired)[:1] + sorted(names & paired) + sorted(names - paired)[1:])

    def differences(self, printed, reference):
        return comparison.differences(printed, FILES, reference, clients.EVERYTHING)

    def test_the_same_lines_agree(self):
        assert self.differences(self.output, self.output) == []

    def test_each_difference_is_named(self):
        for altered in (
            self.output[:1] + ["lost"] + self.output[2:],
            self.output[:1] + self.output[2:],
            self.output[:2] + ["ok"] + self.output[2:],
            self.output[:-2],
        ):
            assert len(self.differences(altered, self.output)) == 1

    def test_sections_that_are_alike_are_compared(self):
        altered = [
            line for name in self.output for line in ([name, "ok reward=1"] if name == "section rle" else [name])
        ]
        assert "rle, which is like hex" in " ".join(self.differences(altered, altered))

    def test_a_client_gets_the_sections_that_it_can_hold(self):
        assert comparison.section_names(FILES) < comparison.section_names(FILES, ("unix",))
        assert "unix" not in comparison.section_names(FILES)
        assert "connect $TLS $TOKEN\n" not in comparison.steps(FILES, ())


class TestCoverage:
    def test_what_is_left_out_is_named(self):
        steps = comparison.steps(FILES, clients.EVERYTHING)
        without = [line for line in steps if not line.startswith("> poke")]
        assert "command poke" in coverage.missing(BINARY, without, [])
        assert "command poke" not in coverage.missing(BINARY, steps, [])
        assert "error code busy" in coverage.missing(BINARY, steps, [])
        assert "error code busy" not in coverage.missing(BINARY, steps, ["error busy"])
        assert "choice of open life_loss=reported" in coverage.missing(BINARY, [], [])

    def test_a_key_that_is_not_described_is_named(self):
        assert coverage.keys_without_description(
            ["ok reward=1 luck=2 final_grey84x4=3:4 grey40x30x2=5", "error luck=3"]
        ) == ["luck"]

    def test_it_reads_the_help_of_the_server(self):
        counts = {kind: len(names) for kind, names in coverage.expected(BINARY).items()}
        document = (SOURCE / "protocol/PROTOCOL.md").read_text()
        rows = re.findall(
            r"^\| `(\w+)[^|]*` \|", document.split("## Commands")[1].split("###")[0].replace("\\|", "/"), re.MULTILINE
        )
        codes = re.findall(r"^\| `([\w-]+)` \|", document.split("## Errors")[1], re.MULTILINE)
        assert (counts["command"], counts["error code"], counts["encoding"]) == (len(rows), len(codes), 6)


class TestVersions:
    def test_all_packages_have_that_of_the_project(self):
        def found(path, pattern):
            return re.search(pattern, (SOURCE / path).read_text())[1]

        version = found("CMakeLists.txt", r"project\(racebeam VERSION ([\d.]+)")
        assert found("clients/java/pom.xml", r"<artifactId>racebeam</artifactId>\s*<version>(.*?)</version>") == version
        assert found("clients/js/package.json", r'"version": "(.*?)"') == version
        assert found("clients/lua/racebeam/init.lua", r'_VERSION = "(.*?)"') == version
        assert found(f"clients/lua/racebeam-{version}-1.rockspec", r'version = "(.*?)"') == f"{version}-1"

    def test_ctest_runs_each_client(self):
        names = re.findall(r"foreach\(client ([^)]*)\)", (SOURCE / "tests/clients/CMakeLists.txt").read_text())[
            0
        ].split()
        assert names == [client.name for client in clients.CLIENTS]
