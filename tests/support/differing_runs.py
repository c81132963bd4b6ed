"""Judges the runs of a comparison that differ: check() for a test, report() for a program."""


def check(found, count):
    """Asserts that there were runs, and that none differs."""
    assert count
    assert found == []


def report(found, count):
    """Prints a line for each run that differs, and their number. Returns the exit status."""
    print(*(f"FAILED: {line}" for line in found), f"{count} runs: {len(found)} differ", sep="\n")
    return int(bool(found) or not count)
