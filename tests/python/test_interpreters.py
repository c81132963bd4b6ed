"""racebeam works in the main interpreter of a process. A sub-interpreter is refused, and breaks nothing."""

import subprocess
import sys

import package

package.require("numpy")

# A second interpreter, which shares the GIL with the first. The modules that make one have had several names.
SECOND = """
try:
    import _interpreters as interpreters
    second = interpreters.create("legacy")
except ImportError:
    import _xxsubinterpreters as interpreters
    second = interpreters.create(isolated=False)

def in_second(text):
    interpreters.run_string(second, text)
"""

IMPORT = """
try:
    import racebeam
except ImportError as error:
    print("refused:", error, flush=True)
else:
    print(type(racebeam.ALEInterface()).__name__, flush=True)
"""

REFUSED = (
    "refused: racebeam was imported in a sub-interpreter, and it works only in the main interpreter of a process; "
    "import it there, or in another process"
)


class TestInterpreters:
    def output_of(self, program):
        done = subprocess.run(
            [sys.executable, "-W", "error", "-c", SECOND + program], capture_output=True, text=True, timeout=120
        )
        assert (done.returncode, done.stderr) == (0, "")
        return done.stdout.splitlines()

    def test_a_sub_interpreter_is_refused_and_the_main_one_goes_on(self):
        assert self.output_of(f"""
import racebeam
in_second({IMPORT!r})
in_second({IMPORT!r})
ale = racebeam.ALEInterface()
ale.setInt("random_seed", 1)
ale.loadROM("builtin:beamfall")
print(ale.getInt("random_seed"), ale.getScreen().shape, ale.act(racebeam.Action.NOOP), "beamfall" in racebeam.games())
try:
    ale.loadROM("/nowhere")
except RuntimeError as error:
    print(type(error).__name__)
""") == [REFUSED, REFUSED, "1 (210, 160) 0 True", "InvalidInput"]

    def test_the_main_interpreter_has_it_after_a_sub_interpreter_was_refused(self):
        assert self.output_of(f"in_second({IMPORT!r})\nin_second({IMPORT!r})\nexec({IMPORT!r})") == [
            REFUSED,
            REFUSED,
            "ALEInterface",
        ]
