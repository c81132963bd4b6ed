"""Prints a header in which the comments of declarations are those of Doxygen: the lines of // before one, and // behind
one. The comment that a header begins with describes the file. Private parts of classes are left out: Doxygen would
link to them, but it has no page for them."""

import re
import sys

BEFORE = re.compile(r"^(\s*)//(?!/)")
PRIVATE = re.compile(r"^ private:.*?(?=^ public:|^ protected:|^\};)", re.MULTILINE | re.DOTALL)
BEHIND = re.compile(r"^(\s*[^/\s].*[;,{]\s+)//(?!/)")

with open(sys.argv[1], encoding="utf-8") as header:
    text = PRIVATE.sub(lambda found: "\n" * found[0].count("\n"), header.read())
if BEFORE.match(text):
    print("/// @file")
for line in text.splitlines():
    print(BEHIND.sub(r"\1///<", BEFORE.sub(r"\1///", line)))
