"""Numbers of options, for the scripts of this folder."""

import argparse


def positive(text: str) -> int:
    """A type of argparse: whole numbers from 1 on."""
    if not (text.isascii() and text.isdecimal() and int(text) > 0):
        raise argparse.ArgumentTypeError(f"it is {text!r}; it takes a whole number from 1 on")
    return int(text)
