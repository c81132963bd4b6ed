"""Compares the interpreter of Thumb code with Unicorn, instruction by instruction, on random programs.

    compare_with_unicorn.py PROBE [--programs N] [--seed N]

Registers and flags are compared after each instruction, and the RAM at the end of each program. Needs Unicorn, from
.venv if this Python lacks it. Status 0: all are equal; 1: one differs; 77: Unicorn is missing.
"""

import argparse
import glob
import os
import random
import struct
import subprocess
import sys

import thumb_programs

SOURCE = os.path.abspath(os.path.join(os.path.dirname(__file__), *[os.pardir] * 3))
SKIPPED = 77
BL_PREFIX = 0x1E  # Unicorn executes it with the instruction that follows, but at a page's end


def unicorn_package():
    """The modules unicorn and unicorn.arm_const, or None."""
    for folder in glob.glob(os.path.join(SOURCE, ".venv", "lib", "python*", "site-packages")):
        sys.path.append(folder)
    try:
        import unicorn
        import unicorn.arm_const
    except ImportError:
        return None
    return unicorn, unicorn.arm_const


class Reference:
    """A machine with the memory of the cartridge. The processor is an ARM925T, which is an ARMv4T."""

    def __init__(self, package, flash, ram):
        unicorn, arm = package
        self.ram = ram
        self.uc = unicorn.Uc(unicorn.UC_ARCH_ARM, unicorn.UC_MODE_THUMB)
        self.uc.ctl_set_cpu_model(arm.UC_CPU_ARM_TI925T)
        self.uc.mem_map(0, len(flash), unicorn.UC_PROT_READ | unicorn.UC_PROT_EXEC)
        self.uc.mem_write(0, flash)
        self.uc.mem_map(thumb_programs.RAM, len(ram))
        self.names = [getattr(arm, f"UC_ARM_REG_R{number}") for number in range(16)]
        self.status = arm.UC_ARM_REG_CPSR

    def begin(self, registers, flags):
        self.uc.mem_write(thumb_programs.RAM, self.ram)
        for name, value in zip(self.names, registers):
            self.uc.reg_write(name, value)
        self.uc.reg_write(self.status, self.uc.reg_read(self.status) & 0x0FFFFFFF | flags)

    def step(self):
        self.uc.emu_start(self.uc.reg_read(self.names[15]) | 1, 0xFFFFFFFE, count=1)
        values = [self.uc.reg_read(name) for name in self.names]
        values[15] &= ~1
        return (*values, self.uc.reg_read(self.status) & 0xF0000000)

    def final_ram(self):
        return bytes(self.uc.mem_read(thumb_programs.RAM, len(self.ram)))


def difference(reference, flash, case, trace, ram):
    """What differs in one program, as text; else None."""
    reference.begin(case.registers, case.flags)
    position, at = 0, case.registers[15]
    while position < len(trace):
        code = struct.unpack_from("<H", flash, at)[0]
        theirs = reference.step()
        position += 2 if code >> 11 == BL_PREFIX and theirs[15] != at + 2 else 1
        if position > len(trace):
            break
        ours = trace[position - 1]
        if theirs != ours:
            rows = [f"instruction {code:04x} at {at:08x}, {position - 1} instructions after the start"]
            names = [f"R{number}" for number in range(16)] + ["flags"]
            rows += [f"  {name}: {a:08x} in Unicorn, {b:08x} here" for name, a, b in zip(names, theirs, ours) if a != b]
            return "\n".join(rows)
        at = theirs[15]
    return None if reference.final_ram() == ram else "the RAM differs"


def answers(output, cases):
    """For each case, its trace and its RAM."""
    words = struct.Struct("<17I")
    at = 0
    for case in cases:
        end = at + words.size * case.instructions
        yield case, list(words.iter_unpack(output[at:end])), output[end : end + thumb_programs.RAM_SIZE]
        at = end + thumb_programs.RAM_SIZE


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("probe")
    parser.add_argument("--programs", type=int, default=1500)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    package = unicorn_package()
    if package is None:
        print("Unicorn is missing: scripts/reference installs it")
        return SKIPPED
    rng = random.Random(options.seed)
    flash, cases = thumb_programs.make(rng, options.programs)
    ram = rng.randbytes(thumb_programs.RAM_SIZE)
    given = flash + ram + b"".join(case.as_bytes() for case in cases)
    output = subprocess.run([options.probe], input=given, stdout=subprocess.PIPE, check=True).stdout
    reference = Reference(package, flash, ram)
    steps = 0
    for number, (case, trace, final) in enumerate(answers(output, cases)):
        found = difference(reference, flash, case, trace, final)
        if found:
            print(f"program {number} of seed {options.seed}: {found}")
            return 1
        steps += len(trace)
    print(f"{len(cases)} programs, {steps} instructions: all are as in Unicorn")
    return 0


if __name__ == "__main__":
    sys.exit(main())
