"""Runs the tests of this folder. The last line counts them. Usage: python3 tests/cluster [--slice] [NAME...]

NAME: such as test_slurm.Slice, or test_slurm.Whole.test_scancel_leaves_nothing. --slice: without the long ones.
"""

import argparse
import sys
import unittest

SLICE = ["test_kubernetes", "test_simulation", "test_slurm.Slice"]
WHOLE = [*SLICE, "test_slurm.Whole"]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--slice", action="store_true")
    parser.add_argument("names", nargs="*", metavar="NAME")
    options = parser.parse_args()
    unittest.installHandler()  # Ctrl-C ends the cluster, too
    suite = unittest.defaultTestLoader.loadTestsFromNames(options.names or (SLICE if options.slice else WHOLE))
    result = unittest.TextTestRunner(stream=sys.stdout, verbosity=2).run(suite)
    failed, skipped = len(result.failures) + len(result.errors), len(result.skipped)
    passed = max(result.testsRun - failed - skipped, 0)
    print(f"{passed} passed, {failed} failed, {skipped} skipped")
    sys.exit(failed > 0)


if __name__ == "__main__":
    main()
