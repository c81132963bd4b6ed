"""Prints a header in which the comments of declarations are those of Doxygen: the lines of // before one, and // behind
one. The comment that a header begins with describes the file."""

import re
import sys

BEFORE = re.compile(r"^(\s*)//(?!/)")
BEHIND = re.compile(r"^(\s*[^/\s].*[;,{]\s+)//(?!/)")

with open(sys.argv[1], encoding="utf-8") as header:
    text = header.read()
if BEFORE.match(text):
    print("/// @file")
for line in text.splitlines():
    print(BEHIND.sub(r"\1///<", BEFORE.sub(r"\1///", line)))
