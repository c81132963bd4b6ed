"""The conversations in protocol/CLASSIC.md are what the server says."""

import os
import re
import shlex
import unittest

from harness import SOURCE, main, run


def conversations(path):
    """For each '$ racebeam' in the document: the command, what is sent, and what comes back."""
    found = []
    with open(os.path.join(SOURCE, path)) as document:
        for line in document:
            mark, text = line[4:6], line[6:]
            if not line.startswith("    "):
                continue
            if mark == "$ ":
                found.append((shlex.split(text)[1:], [], []))
            elif mark in ("> ", "< "):
                found[-1][1 if mark == "> " else 2].append(text)
    return found


class Documents(unittest.TestCase):
    def test_the_conversations_of_the_classic_protocol_are_real(self):
        found = conversations("protocol/CLASSIC.md")
        self.assertTrue(found)
        for command, said, heard in found:
            with self.subTest(command=command):
                status, output, _ = run(*command, data="".join(said).encode())
                expected = re.escape("".join(heard)).replace(re.escape("..."), "[0-9A-F]+")
                self.assertRegex(output.decode(), f"\\A{expected}\\Z")
                self.assertEqual(status, 0)


if __name__ == "__main__":
    main()
