"""The tables of the client in bash."""

from javascript_client import entries_of
from regions import with_region

PATH = "clients/shell/racebeam.bash"


def array(name, pairs):
    values = "".join(f"  [{key}]={str(value).strip(chr(34))}\n" for key, value in pairs)
    return f"declare -rA {name}=(\n{values})\n"


def fields(protocol):
    usual, sizes, pixels = entries_of(protocol)
    return (
        "# The encodings of fields of bytes where a request does not name one.\n"
        + array("racebeam_usual", usual)
        + "# The sizes in bytes of fields whose size never changes; bytes per pixel of those with the screen's size.\n"
        + array("_racebeam_sizes", sizes)
        + array("_racebeam_pixels", pixels)
    )


def files(protocol, read):
    return {PATH: with_region(read(PATH), "", "#", "fields", fields(protocol))}
