"""Runs the tests of this folder. The last line counts them. Usage: python3 tests/cluster [NAME...]

NAME: such as test_kubernetes.Monitoring.
"""

import argparse
import sys
import unittest

TESTS = ["test_kubernetes"]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME")
    options = parser.parse_args()
    suite = unittest.defaultTestLoader.loadTestsFromNames(options.names or TESTS)
    result = unittest.TextTestRunner(stream=sys.stdout, verbosity=2).run(suite)
    failed, skipped = len(result.failures) + len(result.errors), len(result.skipped)
    passed = max(result.testsRun - failed - skipped, 0)
    print(f"{passed} passed, {failed} failed, {skipped} skipped")
    sys.exit(failed > 0)


if __name__ == "__main__":
    main()
