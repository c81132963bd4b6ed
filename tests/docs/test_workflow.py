"""The workflow, the hooks and the scripts of continuous integration name what exists, and leave nothing out."""

import json
import os
import re
import subprocess
import tempfile

import tomllib
from tree import ROOT

WORKFLOW = ".github/workflows/ci.yml"
WHEELS = ".github/workflows/wheels.yml"
FILES = (WORKFLOW, WHEELS, ".pre-commit-config.yaml", ".ci/run", ".ci/nightly")

# Programs that are not steps of .ci/nightly, and why.
LEFT_OUT = {
    "scripts/bench": "it measures, on a quiet machine",
    "scripts/build": "tests use it",
    "scripts/demo": "tests/cli/test_demo.py runs it",
    "scripts/evaluation": "a test of ctest",
    "scripts/instructions": "a test of ctest",
    "scripts/reference": "scripts/test runs it",
    "scripts/run-tests": "scripts/test runs it",
    "scripts/setup": "it installs",
    "scripts/check/signature": "it prints a digest, which a person compares",
    "scripts/version": "tests/cli/test_version.py runs it",
    "scripts/wheel": "a test of ctest",
    "scripts/check/api": "a test of ctest",
    "scripts/check/classic-conformance": "it needs the program of ALE 0.6.0",
    "scripts/check/java-agent": "it needs a checkout of ALE 0.6.0",
    "scripts/check/python-exactness": "it takes hours, and tests run a part of it each day",
    "scripts/check/rules-table": "a test of ctest",
    "scripts/check/translated": "it prints a listing",
    "scripts/check/vectors": "it needs the published vectors",
    "scripts/check/verify-with-ale": "it needs the results of an experiment",
}

# Scripts that load packages without their exact version, and why. None of them makes a package.
UNPINNED = {
    "platforms/installers/aarch64.bash": "its environment for tests",
    "packages/conan/check": "it tests with any Conan 2",
    "scripts/check/gymnasiums": "dm-env; the versions of Gymnasium are its arguments",
    "scripts/check/learners": "it tests with the libraries that users get",
    "scripts/cluster-test": "it tests with the Ray and the schemas that users get",
    "scripts/evaluation": "its environment for tests; the wheel is made by hatchling, which is pinned",
    "scripts/reference": "NumPy, for ale-py, which is pinned",
    "scripts/wheel": "its environment for tests; what makes the wheel is pinned",
}
INSTALL = re.compile(r"""^[^#\n]*(?:\bbring|\bpip(?:"|')?(?: -q)? install) (.*)""", re.MULTILINE)
WORD = re.compile(r"""'[^']*'|"[^"]*"|[^\s;]+""")
PACKAGE = re.compile(r"[A-Za-z][\w.-]*(?:\[\w+\])?(?:[<>=!~;].*)?$")
LOADER = re.compile(
    r"^[^#\n]*(?:^|[\s;&|(])(?:curl|wget|git clone|npx|gem install|luarocks install|npm install) ", re.MULTILINE
)


def read(file):
    return (ROOT / file).read_text()


def presets():
    presets = json.loads(read("CMakePresets.json"))
    return {preset["name"] for preset in presets["configurePresets"] if not preset.get("hidden")}


def nightly_steps():
    output = subprocess.run([ROOT / ".ci/nightly", "--list"], capture_output=True, text=True, check=True).stdout
    return dict(line.split(maxsplit=1) for line in output.splitlines())


class TestWorkflow:
    def names(self, pattern):
        found = [name for file in FILES for name in re.findall(pattern, read(file))]
        assert found, pattern
        return set(found)

    def test_its_presets_exist(self):
        assert self.names(r"--preset ([\w-]+)") - presets() == set()

    def test_its_scripts_exist(self):
        names = self.names(r"(?<![\w/])((?:scripts|\.ci|tests|platforms)/[\w./-]*\w)")
        assert {name for name in names if not (ROOT / name).exists()} == set()

    def test_its_jobs_are_the_steps_of_the_night(self):
        jobs = re.findall(r"^ {10}- ([a-z -]+)$", read(WORKFLOW), re.MULTILINE)
        assert sorted(" ".join(jobs).split()) == sorted(nightly_steps())

    def test_what_makes_packages_has_its_version_pinned(self, subtests):
        builders = {
            "scripts/wheel": "build wheel auditwheel scikit-build-core nanobind",
            "scripts/evaluation": "hatchling",
            "scripts/reference": "ale-py",
        }
        for script, packages in builders.items():
            lines = re.findall(r"^.*\b(?:bring|need) .*$", read(script), re.MULTILINE)
            for package in packages.split():
                with subtests.test(script=script, package=package):
                    assert any(re.search(rf"(?<![\w-]){package}==\d", line) for line in lines)
        assert "npm ci" in read("scripts/viewer")
        assert "ruff==$version" in read("scripts/format")

    def scripts(self):
        folders = (
            "scripts",
            "scripts/check",
            ".ci",
            "platforms",
            "platforms/installers",
            "packages/conan",
            "packages/docker",
            "packages/vcpkg",
        )
        for folder in folders:
            for path in (ROOT / folder).iterdir():
                if path.is_file() and path.suffix != ".md":
                    yield path.relative_to(ROOT).as_posix(), path.read_text()

    def test_scripts_load_exact_versions_or_say_why_not(self):
        unpinned = set()
        for name, text in self.scripts():
            for line in INSTALL.findall(text.replace("\\\n", " ")):
                words = [word.strip("'\"") for word in WORD.findall(re.split(r" (?:\|\||&&|>&2|\{)", line)[0])]
                packages = [word for word in words if PACKAGE.match(word) and "/" not in word]
                unpinned |= {name for word in packages if "==" not in re.sub(r";.*", "", word)}
        assert unpinned == set(UNPINNED)

    def test_scripts_load_nothing_by_address(self):
        assert [name for name, text in self.scripts() if LOADER.search(text)] == []

    def test_wheels_are_built_for_every_python_of_the_package(self):
        config = tomllib.loads(read("pyproject.toml"))
        built = set(re.findall(r"\b(cp\d+t?)-", self.expanded(config["tool"]["cibuildwheel"]["build"])))
        assert built == {"cp310", "cp311", "cp312", "cp313", "cp314", "cp314t"}
        assert config["project"]["requires-python"] == ">=3.10"
        assert config["tool"]["scikit-build"]["wheel"]["py-api"] in built
        assert re.search(r"cibuildwheel==\d+\.\d+\.\d+ ", read(WHEELS))

    def expanded(self, patterns):
        """Patterns of the form a[0-4]b are replaced by what they match."""
        span = re.compile(r"(\S*)\[(\d)-(\d)\](\S*)")
        return span.sub(lambda m: " ".join(f"{m[1]}{n}{m[4]}" for n in range(int(m[2]), int(m[3]) + 1)), patterns)

    def test_actions_are_named_by_their_commit(self):
        uses = re.findall(r"uses: (.*)", read(WORKFLOW) + read(WHEELS))
        assert uses
        for action in uses:
            assert re.search(r"^[\w/-]+@[0-9a-f]{40} # v[\d.]+$", action)


class TestNightly:
    def test_it_runs_every_program_or_says_why_not(self):
        programs = {
            path.relative_to(ROOT).as_posix()
            for folder in ("scripts", "scripts/check")
            for path in (ROOT / folder).iterdir()
            if path.is_file() and os.access(path, os.X_OK)
        }
        run = set(re.findall(r"scripts/[\w/-]+", " ".join(nightly_steps().values())))
        run |= {"scripts/check/pythons"}  # by a function
        assert programs - run == set(LEFT_OUT)

    def test_a_step_that_is_not_there_is_refused(self):
        run = subprocess.run([ROOT / ".ci/nightly", "moon"], capture_output=True, text=True)
        assert (run.returncode, run.stderr) == (2, "nightly: unknown step 'moon'; --list has the steps\n")


class TestSteps:
    def end_of(self, *lines):
        script = "set -euo pipefail\nsource .ci/steps.bash\n" + "\n".join(lines) + "\nfinish"
        run = subprocess.run(["bash", "-c", script], cwd=ROOT, capture_output=True, text=True)
        return run.returncode, re.sub(r"\d+ s\b", "N s", run.stdout).splitlines()

    def test_all_steps_are_run_and_counted(self):
        status, lines = self.end_of(
            "run one echo '3 passed, 0 failed, 1 skipped'",
            "run two bash -c 'echo 4 passed, 1 failed, 0 skipped; exit 1'",
            "run three bash -c 'exit 77'",
            "run four echo well",
        )
        assert status == 1
        assert lines[-4:] == [
            "ci: left out: three",
            "ci: failed: two",
            "ci: 4 steps in N s: 2 passed, 1 failed, 1 left out",
            "7 passed, 1 failed, 1 skipped",
        ]
        assert "ci: the end of two:" in lines

    def test_it_is_green_if_nothing_failed(self):
        status, lines = self.end_of("run one echo well", "run two bash -c 'exit 77'")
        assert (status, lines[-1]) == (0, "0 passed, 0 failed, 0 skipped")


def words_of_ctest(folder):
    """The words of the nearest CMakeLists.txt above a folder, and where it is."""
    while not (folder / "CMakeLists.txt").exists():
        folder = folder.parent
    return re.findall(r"[\w./+]+", (folder / "CMakeLists.txt").read_text()), folder


class TestCtest:
    def test_it_runs_each_file_of_tests(self):
        missing = []
        for path in sorted((ROOT / "tests").rglob("test_*.py")):
            words, folder = words_of_ctest(path.parent)
            file = path.relative_to(folder)
            if not {str(file), file.parts[0], "."} & set(words) and "cluster" not in path.parts:
                missing.append(path.relative_to(ROOT).as_posix())
        assert missing == []


class TestSubjects:
    def refusal(self, subject):
        with tempfile.NamedTemporaryFile("w", suffix=".txt") as file:
            file.write(f"{subject}\n\nThe reason. It may be long, and end with a stop.\n")
            file.flush()
            command = [ROOT / ".ci/subjects", "--message", file.name]
            run = subprocess.run(command, capture_output=True, text=True)
        assert run.returncode == (1 if run.stdout else 0)
        return run.stdout

    def test_a_component_and_72_characters(self):
        for subject in ("tia: x", "docs/spec, tests: HMOVE in the last cycle", "a: " + "x" * 69):
            assert self.refusal(subject) == "", subject
        assert "it has 73 characters, more than 72" in self.refusal("a: " + "x" * 70)
        for subject in ("Mend the TIA", "tia:x", "Tia: x", "tia: ", "tia: an end."):
            assert "it is not 'component: what it does'" in self.refusal(subject), subject


def alternatives(pattern):
    """The patterns without groups that a pattern consists of. A pattern may be in the list several times."""
    group = re.search(r"\(([^()]*)\)", pattern)
    if not group:
        return pattern.split("|")
    before, after = pattern[: group.start()], pattern[group.end() :]
    return [path for word in group[1].split("|") for path in alternatives(before + word + after)]


class TestChanged:
    def touched(self, table, *files):
        script = f"source .ci/changed.bash; most_touched {table} otherwise"
        run = subprocess.run(["bash", "-c", script], cwd=ROOT, input="\n".join(files), capture_output=True, text=True)
        return run.stdout.strip()

    def test_the_paths_select_the_step(self):
        assert self.touched("step_paths", "server/server.cpp", "docs/a.md") == "thread"
        assert self.touched("step_paths", "recording/gif.cpp", "server/server.cpp", "recording/a.cpp") == "address"
        assert self.touched("step_paths", "emulator/cpu/cpu.cpp") == "clang"
        assert self.touched("step_paths", "docs/a.md") == "otherwise"
        assert self.touched("step_paths") == "otherwise"

    def test_every_fuzz_target_has_its_paths(self):
        targets = {path.name for path in (ROOT / "fuzz/corpora").iterdir()}
        table = re.findall(r"^  \[(\w+)\]='", read(".ci/changed.bash").split("fuzz_paths=(")[1], re.MULTILINE)
        assert set(table) == targets
        assert self.touched("fuzz_paths", "recording/gif.cpp") == "media"

    def test_every_alternative_of_the_paths_exists(self):
        files = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True).stdout
        for pattern in re.findall(r"\]='(.*)'$", read(".ci/changed.bash"), re.MULTILINE):
            for path in alternatives(pattern):
                assert re.search(f"(?m){path}" if files else "", files)

    def test_alternatives_are_those_of_nested_groups(self):
        assert alternatives("^a/(b|c(d|e))/|^f") == ["^a/b/", "^f", "^a/cd/", "^f", "^a/b/", "^f", "^a/ce/", "^f"]


class TestPlatforms:
    def test_setup_sources_each_installer_and_calls_each_function(self):
        setup, parts = read("platforms/setup"), sorted((ROOT / "platforms/installers").iterdir())
        sourced = re.search(r"^for part in (.*); do$", setup, re.MULTILINE)[1].split()
        assert sorted(sourced) == [path.stem for path in parts]
        texts = [setup, *(path.read_text() for path in parts)]
        functions = [name for text in texts for name in re.findall(r"^(\w+)\(\) \{", text, re.MULTILINE)]
        assert len(functions) > 10
        for name in functions:
            assert any(re.search(rf"(?<![\w/.-]){name}( [\w$\";]|$)", text, re.MULTILINE) for text in texts), name

    def expanded(self, words):
        command = ["bash", "-c", "printf '%s\\n' " + " ".join(" ".join(words).split())]
        return set(subprocess.run(command, capture_output=True, text=True, check=True).stdout.split())

    def test_its_scripts_name_tests_that_exist(self):
        for script in ("tests", "program", "wheel"):
            words = re.findall(r"(?<![\w/$.-])tests/[\w/{},.-]*[\w}]", read(f"platforms/{script}"))
            paths = self.expanded(words)
            assert len(paths) >= 8, script
            assert {path for path in paths if not (ROOT / path).exists()} == set(), script

    def test_its_programs_of_tests_exist(self):
        lists = re.findall(r"\bprograms\+?=\(([^)]*)\)", read("platforms/tests"))
        programs = {word.split(":")[0] for word in self.expanded(lists)}
        assert len(programs) > 10
        for program in programs:
            folder, name = program.split("/")
            assert re.search(rf"\b{name}\b", read(f"tests/{folder}/CMakeLists.txt")), program

    def test_the_cases_that_are_left_out_exist(self):
        """If a name is misspelt, the case is not left out: it runs there, and fails or takes hours."""
        script = read("platforms/tests")
        sources = {path.stem: path.read_text() for path in (ROOT / "tests").rglob("*_test.cpp")}
        files = re.search(r"'~\[#%s_test\]' (.*?)\)", script.replace("\\\n", " "))[1].split()
        assert len(files) > 5
        assert {name for name in files if f"{name}_test" not in sources} == set()
        names = re.findall(r'~"\*?([^"*]+)\*?"', script)
        assert len(names) > 2
        for name in names:
            assert any(name in re.sub(r'"\s*"', "", text) for text in sources.values()), name
        deselected = re.findall(r"--deselect (\S+\.py)::\w+::(\w+)", script + read("platforms/wheel"))
        assert len(deselected) > 2
        for file, case in deselected:
            assert f"def {case}(" in read(file)

    def test_setup_refuses_an_unknown_platform_before_it_installs(self):
        done = subprocess.run([ROOT / "platforms/setup", "musl", "commodore"], capture_output=True, text=True)
        assert (done.returncode, done.stdout) == (2, "")
        assert done.stderr == (
            "platforms/setup: unknown platform 'commodore'; accepted: aarch64, windows, macos, musl, wasm, compilers\n"
        )
