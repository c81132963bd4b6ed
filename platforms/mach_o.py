"""Inspects a wheel or a program for macOS: prints what its code needs. Status 1: that is more than it may need.

usage: mach_o.py WHEEL | mach_o.py PROGRAM PROCESSOR    (arm64 or x86_64)
"""

import io
import re
import sys
import zipfile

import lief

PROCESSORS = {"arm64": lief.MachO.Header.CPU_TYPE.ARM64, "x86_64": lief.MachO.Header.CPU_TYPE.X86_64}
LEAST = (11, 0)  # version of macOS
LIBRARY = "/usr/lib/libSystem.B.dylib"
LOADS = lief.MachO.LoadCommand.TYPE.LOAD_DYLIB
LOOKED_UP = -2  # the number of the library of a symbol that the system looks up in the whole process
lief.logging.disable()  # it takes what Zig's linker leaves out for damage


def faults_of_code(name, code, processor):
    of_system = {binding.symbol.name for binding in code.bindings if binding.library_ordinal == 1}
    least = tuple(code.build_version.minos[:2])
    print(
        f"{name}: {processor}, macOS {least[0]}.{least[1]}, {LIBRARY}, {len(of_system)} symbols of it", file=sys.stderr
    )
    yield "processor", code.header.cpu_type, PROCESSORS[processor]
    yield "least macOS", least, LEAST
    yield "libraries", [library.name for library in code.libraries if library.command == LOADS], [LIBRARY]
    yield "signature", code.has_code_signature or processor != "arm64", True  # Apple silicon runs signed code only
    yield "symbols of the system", bool(of_system), True


def faults_of_wheel(path):
    major, minor, processor = re.search(r"macosx_(\d+)_(\d+)_(\w+)\.whl$", path).groups()
    with zipfile.ZipFile(path) as archive:
        names = archive.namelist()
        (name,) = (name for name in names if name.startswith("racebeam/_core.") and name.endswith(".so"))
        module = lief.MachO.parse(io.BytesIO(archive.read(name))).at(0)
    yield from faults_of_code(name, module, processor)
    of_python = {binding.symbol.name for binding in module.bindings if binding.library_ordinal == LOOKED_UP}
    yield "name", name, "racebeam/_core.abi3.so"
    yield "tag", (int(major), int(minor)), LEAST
    yield "symbols that nobody has", sorted(name for name in of_python if not re.match("__?Py", name)), []
    yield "symbols of Python", bool(of_python), True
    yield "exported initialisation", "_PyInit__core" in {symbol.name for symbol in module.exported_symbols}, True
    yield "stub", "racebeam/_core.pyi" in names, True


def faults_of_program(path, processor):
    program = lief.MachO.parse(path).at(0)
    yield from faults_of_code(path, program, processor)
    looked_up = {binding.symbol.name for binding in program.bindings if binding.library_ordinal == LOOKED_UP}
    yield "kind", program.header.file_type, lief.MachO.Header.FILE_TYPE.EXECUTE
    yield "symbols that nobody has", sorted(looked_up), []


faults = faults_of_wheel if sys.argv[1].endswith(".whl") else faults_of_program
wrong = [f"{what}: {found}, not {accepted}" for what, found, accepted in faults(*sys.argv[1:]) if found != accepted]
sys.exit("\n".join(f"mach_o: {sys.argv[1]}: {fault}" for fault in wrong) or 0)
