"""The package as it is installed: what it imports, what its files say, and the program that comes with it."""

import ast
import importlib.metadata
import os
import pathlib
import re
import subprocess
import sys
import tempfile

import package
import pytest

package.require("numpy")

import racebeam
import racebeam._core
from racebeam.extras import install_hint

FOLDER = pathlib.Path(racebeam.__file__).parent


def output(*command):
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout


def needed(file):
    """The libraries that a program or a library loads."""
    return set(re.findall(r"NEEDED.*\[(.*?)\]", output("readelf", "-d", file)))


def python(script, *words, folder=None, **environment):
    return subprocess.run(
        [sys.executable, *words, "-c", script],
        env={**os.environ, **environment},
        cwd=folder,
        capture_output=True,
        text=True,
    )


def has(module):
    return python(f"import {module}").returncode == 0


class TestImport:
    def test_numpy_is_all_that_it_needs(self):
        only_numpy = (
            "import importlib.machinery as m, sys\n"
            "find = m.PathFinder.find_spec\n"
            "hidden = ('gymnasium', 'pygame', 'ale_py', 'jax', 'torch', 'stable_baselines3', 'cv2')\n"
            "m.PathFinder.find_spec = classmethod(lambda c, name, *a: None if name in hidden else find(name, *a))\n"
            "import racebeam, racebeam.ale_py\n"
            "ale = racebeam.ALEInterface(); ale.loadROM('builtin:beamfall'); ale.act(1); "
            "print(ale.getScreenRGB().shape)\n"
            "for name in ('AtariEnv', 'AtariVectorEnv', 'register_ale_ids'):\n"
            "    try: getattr(racebeam, name)()\n"
            "    except ImportError as error: print(error)\n"
            "try: import racebeam.envpool\n"
            "except ImportError as error: print(error)"
        )
        done = python(only_numpy)
        assert done.stdout.splitlines() == [
            "(210, 160, 3)",
            *(
                f"racebeam.{name} needs Gymnasium; {install_hint('gymnasium')}"
                for name in ("AtariEnv", "AtariVectorEnv", "register_ale_ids", "envpool")
            ),
        ], done.stderr

    def test_nothing_heavy_is_imported_before_it_is_used(self):
        heavy = "'pygame', 'ale_py', 'jax', 'torch', 'stable_baselines3', 'cv2'"
        assert python(f"import racebeam, sys; print([m for m in ({heavy},) if m in sys.modules])").stdout == "[]\n"

    def test_results_are_read_by_the_package_of_evaluation(self):
        hidden = "import sys; sys.modules['racebeam_evaluation'] = None\n"  # as if it were not installed
        load = "import racebeam\ntry: print(racebeam.results.load('folder'))\nexcept ImportError as error: print(error)"
        assert (
            python(hidden + load).stdout
            == f"racebeam.results needs racebeam-evaluation; {install_hint('racebeam_evaluation')}\n"
        )
        with tempfile.TemporaryDirectory() as folder:
            made = pathlib.Path(folder, "racebeam_evaluation.py")
            made.write_text("BadInput = Frames = None\ndef load(path): return 'frames of ' + path\n")
            assert python(load, PYTHONPATH=folder).stdout == "frames of folder\n"

    def test_a_part_whose_package_is_missing_says_what_it_needs(self):
        hidden = "import sys; sys.modules['stable_baselines3'] = None\n"  # as if it were not installed
        script = "try: import racebeam.sb3\nexcept ImportError as error: print(error)"
        sentence = f"racebeam.sb3 needs Stable-Baselines3; {install_hint('stable_baselines3')}\n"
        assert python(hidden + script).stdout == sentence

    def test_the_metadata(self):
        described = importlib.metadata.metadata("racebeam")
        version = re.search(r"project\(racebeam VERSION ([0-9.]+)", (package.SOURCE / "CMakeLists.txt").read_text())[1]
        assert (described["Version"], racebeam.__version__) == (version, version)
        requirements = [name for name in importlib.metadata.requires("racebeam") if "extra" not in name]
        assert requirements == ["numpy>=1.24"]

    def test_a_typo_is_an_AttributeError(self):
        with pytest.raises(AttributeError, match="has no attribute 'Atari'"):
            racebeam.Atari  # noqa: B018


class TestFiles:
    @pytest.mark.needs_posix
    def test_only_the_modules_entry_is_seen_by_others(self):
        symbols = subprocess.run(
            ["nm", "-D", "--defined-only", racebeam._core.__file__], capture_output=True, text=True, check=True
        )
        assert {line.split()[2].split("@")[0] for line in symbols.stdout.splitlines()} == {"PyInit__core"}

    @pytest.mark.needs_glibc
    def test_what_is_linked_is_on_every_Linux(self):
        libraries = {"libc.so.6", "libm.so.6", "libgcc_s.so.1", "ld-linux-x86-64.so.2", "libpthread.so.0"}
        assert needed(racebeam._core.__file__) <= libraries
        assert needed(pathlib.Path(sys.executable).parent / "racebeam") == set()

    @pytest.mark.needs_glibc
    def test_it_runs_on_the_systems_that_the_document_names(self):
        claim = re.search(r"`manylinux_2_(\d+)_x86_64`", (package.SOURCE / "docs/python/reference.md").read_text())[1]
        versions = output("readelf", "--version-info", racebeam._core.__file__)
        assert max(map(int, re.findall(r"GLIBC_2\.(\d+)", versions))) <= int(claim)

    @pytest.mark.needs_glibc
    def test_each_function_of_the_C_library_has_a_version(self):
        symbols = output("nm", "-D", "--undefined-only", racebeam._core.__file__).splitlines()
        names = [line.split()[-1] for line in symbols if line.split()[-2] == "U"]
        assert [name for name in names if "@" not in name and not re.match("_?Py", name)] == []

    def test_the_types_are_checked(self):
        assert (FOLDER / "py.typed").exists() and (FOLDER / "_core.pyi").exists()
        if not has("mypy"):
            pytest.skip("mypy is not installed")
        for command in (
            ["mypy", "--strict", "--cache-dir", str(package.SOURCE / "build/python/mypy"), "-p", "racebeam"],
            [
                "mypy.stubtest",
                "racebeam._core",
                "--ignore-disjoint-bases",
                "--allowlist",
                str(package.SOURCE / "tests/python/stubtest_allowed"),
            ],
        ):
            done = subprocess.run(
                [sys.executable, "-m", *command], capture_output=True, text=True, cwd=FOLDER.parent.parent
            )
            assert done.returncode == 0, done.stdout + done.stderr

    def test_types_help_those_who_call(self):
        if not has("mypy") or not has("gymnasium"):
            pytest.skip("mypy or Gymnasium is not installed")
        calls = (
            "import numpy as np, racebeam, racebeam.envpool\n"
            "envs = racebeam.AtariVectorEnv('beamfall', 2, seed=np.int64(3))\n"
            "envs.reset(seed=np.int64(4)), envs.reset(seed=[np.int64(4), None])\n"
            "racebeam.AtariVectorEnv('beamfall', options=racebeam.VectorOptions(), frameskip=2, seed=1)\n"
            "racebeam.AtariVectorEnv('beamfall', frame_skip=2)  # type: ignore[call-arg]\n"
            "racebeam.AtariEnv('beamfall', frame_skip=2)  # type: ignore[arg-type]\n"
            "racebeam.AtariVectorEnv('beamfall', frameskip='2')  # type: ignore[arg-type]\n"
            "reveal_type(envs.step([0, 1]))\n"
            "reveal_type(racebeam.envpool.make('Pong-v5', env_type='gymnasium'))\n"
            "reveal_type(racebeam.envpool.make('Pong-v5', 'dm').reset())\n"
        )
        done = subprocess.run(
            [
                sys.executable,
                "-m",
                "mypy",
                "--strict",
                "--cache-dir",
                str(package.SOURCE / "build/python/mypy"),
                "-c",
                calls,
            ],
            capture_output=True,
            text=True,
            cwd=FOLDER.parent.parent,
        )
        assert done.returncode == 0, done.stdout + done.stderr
        types = re.findall('Revealed type is "(.*)"', done.stdout)
        assert re.search(r"tuple\[.*ndarray\[.*signedinteger\[numpy._typing._nbit_base._32Bit\].*bool", types[0])
        assert re.search("GymnasiumEnvPool.*TimeStep", "".join(types[1:]))


class TestStructure:
    def test_modules_do_not_import_each_other_in_a_circle(self):
        imports = {}
        for file in FOLDER.rglob("*.py"):
            if file.name != "__init__.py":  # these gather the names of their folders
                imports[file] = {
                    other for other in self.imported(file) if other.exists() and other.name != "__init__.py"
                }
        while leaves := [file for file, others in imports.items() if not others & imports.keys()]:
            for file in leaves:
                del imports[file]
        assert sorted(str(file.relative_to(FOLDER)) for file in imports) == []

    def imported(self, file):
        """The files that a module imports anywhere, also where only the types are checked."""
        for node in ast.walk(ast.parse(file.read_text())):
            if isinstance(node, ast.ImportFrom):
                package_of = file.parents[node.level - 1] if node.level else FOLDER.parent
                module = package_of.joinpath(*(node.module or "").split("."))
                yield module.with_suffix(".py")
                yield from ((module / name.name).with_suffix(".py") for name in node.names)


class TestProgram:
    @pytest.mark.needs_program
    def test_it_is_beside_python(self):
        program = pathlib.Path(sys.executable).parent / "racebeam"
        output = subprocess.run([program, "--version"], capture_output=True, text=True, check=True).stdout
        assert racebeam.__version__ in output

    @pytest.mark.needs_program
    def test_launch_finds_it(self):
        with racebeam.launch() as session:
            assert session.load("beamfall", seed=1)["game"] == "beamfall"

    def test_a_missing_program_is_reported(self):
        done = python(
            "import racebeam.program as p\np._find_installed = lambda: None\n"
            "try: racebeam.launch()\nexcept FileNotFoundError as error: print(error)".replace(
                "racebeam.launch", "p.path"
            ),
            PATH="/nowhere",
        )
        reason = (
            "is not on the PATH, and wheels for Windows lack it"
            if os.name == "nt"
            else "is neither beside this package nor on the PATH"
        )
        assert f"the program racebeam {reason}" in done.stdout
