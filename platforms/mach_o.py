"""Inspects the module of a wheel for macOS: prints what it needs. Status 1: that is more than it may need."""

import io
import re
import sys
import zipfile

import lief

PROCESSORS = {"arm64": lief.MachO.Header.CPU_TYPE.ARM64, "x86_64": lief.MachO.Header.CPU_TYPE.X86_64}
LIBRARY = "/usr/lib/libSystem.B.dylib"
LOADS = lief.MachO.LoadCommand.TYPE.LOAD_DYLIB
LOOKED_UP = -2  # the number of the library of a symbol that the system looks up in the whole process
lief.logging.disable()  # it takes what Zig's linker leaves out for damage


def faults(wheel):
    major, minor, processor = re.search(r"macosx_(\d+)_(\d+)_(\w+)\.whl$", wheel).groups()
    with zipfile.ZipFile(wheel) as archive:
        names = archive.namelist()
        (name,) = (name for name in names if name.startswith("racebeam/_core.") and name.endswith(".so"))
        module = lief.MachO.parse(io.BytesIO(archive.read(name))).at(0)
    of_python = {binding.symbol.name for binding in module.bindings if binding.library_ordinal == LOOKED_UP}
    exported = {symbol.name for symbol in module.exported_symbols}
    least = f"{module.build_version.minos[0]}.{module.build_version.minos[1]}"
    print(f"{name}: {processor}, macOS {least}, {LIBRARY}, {len(of_python)} symbols of Python", file=sys.stderr)
    yield "name", name, "racebeam/_core.abi3.so"
    yield "processor", module.header.cpu_type, PROCESSORS[processor]
    yield "least macOS", least, f"{major}.{minor}"
    yield "libraries", [library.name for library in module.libraries if library.command == LOADS], [LIBRARY]
    yield "signature", module.has_code_signature or processor != "arm64", True  # Apple silicon runs signed code only
    yield "symbols that nobody has", sorted(name for name in of_python if not re.match("__?Py", name)), []
    yield "symbols of Python", bool(of_python), True
    yield "exported initialisation", "_PyInit__core" in exported, True
    yield "stub", "racebeam/_core.pyi" in names, True


wrong = [f"{what}: {found}, not {accepted}" for what, found, accepted in faults(sys.argv[1]) if found != accepted]
sys.exit("\n".join(f"mach_o: {sys.argv[1]}: {fault}" for fault in wrong) or 0)
