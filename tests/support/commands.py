"""Commands that a test runs."""

import subprocess


def outcome_of(*command, **options):
    """Runs a command, whose output and errors become one text. `options` are those of subprocess.run()."""
    return subprocess.run(
        [str(word) for word in command], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, **options
    )


def output_of(*command, **options):
    """Runs a command that must succeed, and returns its output.

    Raises:
        AssertionError: If its status is not 0.
    """
    done = outcome_of(*command, **options)
    if done.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, command))}\n{done.stdout}")
    return done.stdout
