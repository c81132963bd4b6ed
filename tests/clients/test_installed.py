"""What `cmake --install` gives is complete: another project is built from it by CMake and by pkg-config, and plays."""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "tests/server"))

from harness import BINARY, SKIPPED  # noqa: E402

BUILD = pathlib.Path(os.environ["RACEBEAM_BUILD"])
CONSUMER = SOURCE / "tests/clients/consumer"
VERSION = subprocess.run([BINARY, "--version"], capture_output=True, text=True, check=True).stdout.split()[1]
SCORE = f"{VERSION} 82 400\n"  # as in protocol/PROTOCOL.md, "States"
PLAIN = {key: value for key, value in os.environ.items() if not key.startswith("CMAKE")}


def run(*command, **variables):
    """What a command prints. The test fails if the command does."""
    done = subprocess.run(
        [str(word) for word in command],
        env={**PLAIN, "RACEBEAM_PROGRAM": BINARY, **variables},
        text=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
    )
    if done.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, command))}\n{done.stdout}")
    return done.stdout


class Installed(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.built = pathlib.Path(folder.name, "built")
        # Not where it was configured for: the tree can be moved.
        cls.prefix = pathlib.Path(folder.name, "elsewhere/racebeam")
        for component in ("development", "program"):
            run("cmake", "--install", BUILD, "--prefix", cls.prefix, "--component", component)
        cls.pkgconfig = next(cls.prefix.glob("lib*/**/pkgconfig"))
        cls.libraries = cls.pkgconfig.parent

    def test_a_project_is_built_by_cmake(self):
        run("cmake", "-S", CONSUMER, "-B", self.built, f"-DCMAKE_PREFIX_PATH={self.prefix}")
        run("cmake", "--build", self.built)
        for name in ("in_process", "on_a_server", "in_process_shared"):
            with self.subTest(name):
                if name == "in_process_shared" and not list(self.libraries.glob("libracebeam.so*")):
                    self.skipTest("configured without RACEBEAM_SHARED")
                self.assertEqual(run(self.built / name, LD_LIBRARY_PATH=str(self.libraries)), SCORE)

    def test_a_program_is_built_by_pkg_config(self):
        for package, name in (("racebeam", "in_process"), ("racebeam-client", "on_a_server")):
            with self.subTest(package):
                told = run("pkg-config", "--cflags", "--libs", package, PKG_CONFIG_PATH=str(self.pkgconfig)).split()
                program = self.prefix / name
                run(os.environ.get("CXX", "c++"), CONSUMER / f"{name}.cpp", "-o", program, *told)
                self.assertEqual(run(program), SCORE)
                version = run("pkg-config", "--modversion", package, PKG_CONFIG_PATH=str(self.pkgconfig))
                self.assertEqual(version.strip(), VERSION)

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
        self.assertRegex(run(agent / "built/agent"), r"^\d+\n$")

    def test_another_version_of_gcc_can_link_it(self):
        sections = run("objdump", "-h", self.libraries / "libracebeam_emulator.a")
        self.assertIn(".text", sections)
        self.assertNotIn(".gnu.lto", sections)

    def test_the_program_runs_where_it_is_installed(self):
        self.assertEqual(run(self.prefix / "bin/racebeam", "--version"), f"racebeam {VERSION}\n")
        self.assertIn("racebeam", os.readlink(self.prefix / "bin/racebeam-ale"))

    def test_no_path_of_the_build_is_left_in_it(self):
        for path in self.prefix.rglob("*"):
            if path.suffix in {".cmake", ".pc", ".hpp"}:
                self.assertNotIn(str(BUILD), path.read_text(), path)
                self.assertNotIn(str(SOURCE), path.read_text(), path)


if __name__ == "__main__":
    if missing := [word for word in ("pkg-config", "c++") if shutil.which(word) is None]:
        print(f"SKIPPED: {missing[0]} is not installed")
        sys.exit(SKIPPED)
    unittest.main(verbosity=2)
