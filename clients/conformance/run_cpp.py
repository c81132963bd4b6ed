"""Builds and runs a program with the client in C++: run_cpp.py FILE WORDS..., or --build FILE, or --probe.

The client's headers are compiled once, ahead. A program is built again only when it or a header has changed.
"""

import hashlib
import os
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
HEADERS = ROOT / "clients/cpp"
BUILT = ROOT / "build/clients/cpp"
COMPILE = (
    os.environ.get("CXX", "c++"),
    "-std=c++20",
    "-O1",
    "-Wall",
    "-Wextra",
    "-Wpedantic",
    "-Werror",
    "-I",
    str(HEADERS),
)
LIBRARIES = ("-lssl", "-lcrypto", "-lz", "-pthread")


def sources():
    return sorted(HEADERS.glob("racebeam/**/*.hpp"))


def digest(*texts):
    return hashlib.sha256(b"\0".join(texts)).hexdigest()[:16]


def compiled_headers():
    """A header beside which the compiler finds it compiled."""
    header = BUILT / digest(*(path.read_bytes() for path in sources()), " ".join(COMPILE).encode()) / "ahead.hpp"
    compiled = header.with_suffix(".hpp.gch")
    if not compiled.exists():
        header.parent.mkdir(parents=True, exist_ok=True)
        header.write_text("#include <racebeam/client.hpp>\n")
        subprocess.run([*COMPILE, "-x", "c++-header", header, "-o", f"{compiled}.{os.getpid()}"], check=True)
        os.rename(f"{compiled}.{os.getpid()}", compiled)
    return header


def built(source):
    """The path of the program that `source` makes."""
    header = compiled_headers()
    program = header.parent / digest(source.read_bytes())
    if not program.exists():
        subprocess.run(
            [*COMPILE, "-include", header, "-x", "c++", source, *LIBRARIES, "-o", f"{program}.{os.getpid()}"],
            check=True,
        )
        os.rename(f"{program}.{os.getpid()}", program)
    return program


def probe():
    """Ends with status 0 if the compiler finds what the client needs."""
    needed = ("boost/asio/awaitable.hpp", "openssl/ssl.h", "zlib.h")
    text = "".join(f"#if !__has_include(<{name}>)\n#error {name}\n#endif\n" for name in needed)
    sys.exit(
        subprocess.run(
            [os.environ.get("CXX", "c++"), "-std=c++20", "-E", "-x", "c++", "-"],
            input=text,
            text=True,
            capture_output=True,
        ).returncode
    )


if __name__ == "__main__":
    if sys.argv[1] == "--probe":
        probe()
    if sys.argv[1] == "--build":
        built(pathlib.Path(sys.argv[2]))
    else:
        program = built(pathlib.Path(sys.argv[1]))
        os.execv(program, [str(program), *sys.argv[2:]])
