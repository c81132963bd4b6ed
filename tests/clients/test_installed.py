"""What `cmake --install` gives is complete: another project is built from it by CMake and by pkg-config, and plays."""

import os
import pathlib
import re
import subprocess
import tempfile

import pytest

SOURCE = pathlib.Path(__file__).resolve().parents[2]

from commands import outcome_of, output_of
from harness import BINARY

pytestmark = [pytest.mark.slow, pytest.mark.needs_programs("pkg-config", "c++")]

BUILD = pathlib.Path(BINARY).parent
CONSUMER = SOURCE / "tests/clients/consumer"
HEADERS = sorted((SOURCE / "include/racebeam").glob("*.hpp*")) + [SOURCE / "clients/cpp/racebeam/client.hpp"]
CXX = os.environ.get("CXX", "c++")
OURS = re.compile(r"_Z(?:T[ISV])?NK?8racebeam")
INTERFACE = re.compile(r"_ZNK?8racebeam2v0|_ZT[ISV]N8racebeam2v0")
STRICT = ("-std=c++20", "-Wall", "-Wextra", "-Wpedantic", "-Werror")
VERSION = subprocess.run([BINARY, "--version"], capture_output=True, text=True, check=True).stdout.split()[1]
SCORE = f"{VERSION} 82 400\n"  # as in protocol/PROTOCOL.md, "States"
PLAIN = {key: value for key, value in os.environ.items() if not key.startswith("CMAKE")}


def with_program(**variables):
    """The environment of a command that finds the program that was built."""
    return {**PLAIN, "RACEBEAM_PROGRAM": BINARY, **variables}


def run(*command, **variables):
    return output_of(*command, env=with_program(**variables))


def name_of(header):
    """The name of a header where it is installed."""
    return f"racebeam/{header.name.removesuffix('.in')}"


def usage_of(header):
    """The program that the comment at the top of a header shows, without what is around it."""
    comment = header.read_text().partition("#pragma once")[0]
    return "\n".join(re.findall(r"^///?     (.*)$|^//$", comment, re.MULTILINE)).strip()


class TestInstalled:
    @pytest.fixture(scope="class", autouse=True)
    @classmethod
    def set_up_class(cls, tmp_path_factory):
        folder = tmp_path_factory.mktemp("installed")
        cls.built = pathlib.Path(folder, "built")
        # The prefix is not the one that was configured: the tree can be moved.
        cls.prefix = pathlib.Path(folder, "elsewhere/racebeam")
        for component in ("development", "program"):
            run("cmake", "--install", BUILD, "--prefix", cls.prefix, "--component", component)
        cls.pkgconfig = next(cls.prefix.glob("lib*/**/pkgconfig"))
        cls.libraries = cls.pkgconfig.parent

    def test_a_project_is_built_by_cmake(self, subtests):
        run("cmake", "-S", CONSUMER, "-B", self.built, f"-DCMAKE_PREFIX_PATH={self.prefix}")
        run("cmake", "--build", self.built)
        for name in ("in_process", "on_a_server", "in_process_shared"):
            with subtests.test(name):
                if name == "in_process_shared" and not list(self.libraries.glob("libracebeam.so*")):
                    pytest.skip("configured without RACEBEAM_SHARED")
                assert run(self.built / name, LD_LIBRARY_PATH=str(self.libraries)) == SCORE

    def configured(self, project, *options):
        """Configures a project in a fresh folder. Returns the status, and what CMake printed, on one line."""
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, "CMakeLists.txt").write_text(
                f"cmake_minimum_required(VERSION 3.25)\nproject(agent LANGUAGES CXX)\n{project}\n"
            )
            prefix = f"-DCMAKE_PREFIX_PATH={self.prefix}"
            done = outcome_of("cmake", "-S", folder, "-B", f"{folder}/b", prefix, *options, env=with_program())
            return done.returncode, " ".join(done.stdout.split())

    def test_without_OpenSSL_a_project_learns_what_the_client_needs(self, subtests):
        need = "needs OpenSSL with its headers, Debian's libssl-dev; OPENSSL_ROOT_DIR names its folder"
        for project, status, sentence in (
            (
                "find_package(racebeam REQUIRED COMPONENTS client)",
                1,
                f"Reason given by package: racebeam::client {need}.",
            ),
            ("find_package(racebeam REQUIRED)", 0, f"racebeam: without racebeam::client, which {need}"),
        ):
            with subtests.test(project):
                hidden = self.configured(project, "-DCMAKE_DISABLE_FIND_PACKAGE_OpenSSL=ON")
                assert hidden[0] == status, hidden[1]
                assert sentence in hidden[1]
                visible = self.configured(project)
                assert visible[0] == 0, visible[1]
                assert "OpenSSL with" not in visible[1]

    def test_a_project_that_requires_the_shared_library_learns_how_to_build_it(self):
        status, text = self.configured("find_package(racebeam REQUIRED COMPONENTS shared)")
        if list(self.libraries.glob("libracebeam.so*")):
            assert status == 0, text
        else:
            assert "racebeam::shared needs the library built with -DRACEBEAM_SHARED=ON." in text

    def test_an_unknown_component_is_refused(self):
        status, text = self.configured("find_package(racebeam REQUIRED COMPONENTS engine)")
        assert status == 1
        assert "accepted: racebeam, shared, client" in text

    @pytest.mark.parametrize("package, name", (("racebeam", "in_process"), ("racebeam-client", "on_a_server")))
    def test_a_program_is_built_by_pkg_config(self, package, name):
        program = self.compiled(name, (CONSUMER / f"{name}.cpp").read_text(), *self.flags(package))
        assert run(program, LD_LIBRARY_PATH=str(self.libraries)) == SCORE
        version = run("pkg-config", "--modversion", package, PKG_CONFIG_PATH=str(self.pkgconfig))
        assert version.strip() == VERSION

    def flags(self, package):
        return run("pkg-config", "--cflags", "--libs", package, PKG_CONFIG_PATH=str(self.pkgconfig)).split()

    def compiled(self, name, text, *flags):
        """A program, compiled with warnings as errors."""
        source = self.prefix / f"{name}.cpp"
        source.write_text(text)
        run(CXX, *STRICT, source, "-o", source.with_suffix(""), *flags)
        return source.with_suffix("")

    @pytest.mark.parametrize("header", HEADERS)
    def test_each_header_stands_by_itself(self, header):
        package = "racebeam-client" if header.name == "client.hpp" else "racebeam"
        text = f"#include <{name_of(header)}>\n#include <{name_of(header)}>\nint main() {{}}\n"
        (self.prefix / "header.cpp").write_text(text)
        run(CXX, *STRICT, "-fsyntax-only", self.prefix / "header.cpp", *self.flags(package))

    @pytest.mark.parametrize("header", HEADERS)
    def test_each_header_shows_a_program_that_runs(self, header):
        package, first = ("racebeam-client", "client") if header.name == "client.hpp" else ("racebeam", "racebeam")
        usage = usage_of(header)
        assert usage
        text = f"#include <iostream>\n#include <racebeam/{first}.hpp>\nint main() {{\n{usage}\n}}\n"
        run(self.compiled("usage", text, *self.flags(package)), LD_LIBRARY_PATH=str(self.libraries))

    @pytest.mark.parametrize("header", HEADERS)
    def test_each_header_says_which_threads_may_use_it(self, header):
        assert re.search("[Tt]hread", header.read_text().partition("     ")[0])

    def test_only_public_headers_are_installed(self):
        installed = {path.relative_to(self.prefix / "include").as_posix() for path in self.prefix.rglob("*.hpp")}
        public = {name for name in installed if not name.startswith("racebeam/client/")}
        assert public == {name_of(header) for header in HEADERS}

    def test_only_the_interface_is_exported(self):
        """The static library exports only the interface: a shared library that is linked with it exports no more."""
        table = run("readelf", "--syms", "--wide", self.libraries / "libracebeam.a")
        symbols = set(re.findall(r"(?:GLOBAL|WEAK) +DEFAULT +\d+ (\S+)", table))
        ours = {name for name in symbols if OURS.match(name)}
        assert "_ZN8racebeam2v07versionEv" in ours
        assert {name for name in ours if not INTERFACE.match(name)} == set()
        for library in self.libraries.glob("libracebeam.so"):
            exported = {line.split()[-1] for line in run("nm", "-D", "--defined-only", library).splitlines()}
            assert "_ZN8racebeam2v07versionEv" in exported
            assert {name for name in exported if not INTERFACE.match(name)} == set()

    def test_a_library_that_hides_the_client_exports_its_exceptions(self):
        """A program catches them. All names of the client have the version of its interface."""
        hidden = self.prefix / "hidden.o"
        compiler = (CXX, "-std=c++20", "-fvisibility=hidden", "-c", CONSUMER / "on_a_server.cpp", "-o", hidden)
        run(*compiler, *self.flags("racebeam-client"))
        table = run("readelf", "--syms", "--wide", hidden)
        assert set(re.findall(r"8racebeam6client(?!2v0)\S*", table)) == set()
        exported = re.findall(r"(?:GLOBAL|WEAK) +DEFAULT +\d+ _ZTIN8racebeam6client2v0\d+(\w+)E", table)
        assert set(exported) == {"Refused", "Lost", "TimedOut"}

    def test_the_programs_of_its_page_are_built(self):
        blocks = dict(
            re.findall(
                r"^```(cpp|cmake)\n(.*?)^```$", (SOURCE / "docs/api/README.md").read_text(), re.MULTILINE | re.DOTALL
            )
        )
        agent = self.prefix / "agent"
        agent.mkdir()
        (agent / "agent.cpp").write_text(blocks["cpp"])
        (agent / "CMakeLists.txt").write_text(blocks["cmake"])
        run("cmake", "-S", agent, "-B", agent / "built", f"-DCMAKE_PREFIX_PATH={self.prefix}")
        run("cmake", "--build", agent / "built")
        assert re.search(r"^\d+\n$", run(agent / "built/agent"))

    def test_another_version_of_gcc_can_link_it(self):
        sections = run("objdump", "-h", self.libraries / "libracebeam.a")
        assert ".text" in sections
        assert ".gnu.lto" not in sections

    def test_the_program_runs_where_it_is_installed(self):
        assert run(self.prefix / "bin/racebeam", "--version") == f"racebeam {VERSION}\n"
        assert "racebeam" in os.readlink(self.prefix / "bin/racebeam-ale")

    def test_no_path_of_the_build_is_left_in_it(self):
        for path in self.prefix.rglob("*"):
            if path.suffix in {".cmake", ".pc", ".hpp"}:
                assert str(BUILD) not in path.read_text(), path
                assert str(SOURCE) not in path.read_text(), path
