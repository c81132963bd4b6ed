"""The tables of the client in bash."""

from javascript_client import entries_of
from regions import with_region

PATH = "clients/shell/racebeam.bash"


def array(name, pairs):
    values = " ".join(f"[{key}]={str(value).strip(chr(34))}" for key, value in pairs)
    return f"declare -rA {name}=({values})\n"


def fields(protocol):
    usual, sizes, pixels = entries_of(protocol)
    return (
        "# What bytes are written in where the client does not say.\n"
        + array("racebeam_usual", usual)
        + (
            "# Bytes of fields that always have the same number, and bytes of a pixel of those that have the size "
            "of the screen.\n"
        )
        + array("_racebeam_sizes", sizes)
        + array("_racebeam_pixels", pixels)
    )


def files(protocol, read):
    return {PATH: with_region(read(PATH), "", "#", "fields", fields(protocol))}
