"""Random programs of Thumb code, in flash memory. What an ARMv4T leaves open is not in them, nor what Unicorn does
not do: unaligned numbers, and addresses without memory."""

import dataclasses
import struct

FLASH_SIZE, RAM_SIZE, RAM = 0x8000, 8192, 0x40000000
DATA = 0x6000  # of the flash memory: code ends here
LENGTH = 24  # units of a program

# R0 to R5 have any values. R6 points into the data of the flash memory and R7 into RAM, at words.
FREE, POINTERS = range(6), (6, 7)
TELLING = (0, 1, 2, 31, 32, 33, 0x7F, 0x80, 0xFF, 0x100, 0x7FFFFFFF, 0x80000000, 0x80000001, 0xFFFFFFFE, 0xFFFFFFFF)


@dataclasses.dataclass
class Case:
    registers: list
    flags: int
    instructions: int

    def as_bytes(self):
        return struct.pack("<18I", *self.registers, self.flags, self.instructions)


class Writer:
    """Writes programs one after the other. Each unit is an instruction, or a few that belong together."""

    def __init__(self, rng):
        self.rng = rng
        self.codes = []
        self.units = (
            [self.shift] * 3
            + [self.add_or_subtract] * 2
            + [self.with_number] * 2
            + [self.alu] * 6
            + [self.any_register] * 3
            + [self.load_from_code, self.indexed, self.indexed, self.signed, self.near, self.near, self.half]
            + [self.stack_place, self.address, self.move_stack, self.push, self.pop, self.multiple, self.multiple]
            + [self.branch_if] * 4
            + [self.branch, self.call, self.call_back, self.jump, self.jump_by_sum]
        )

    def program(self):
        """The offset of a new program, and an upper limit of the instructions that it executes."""
        start = 2 * len(self.codes)
        for _ in range(LENGTH):
            self.rng.choice(self.units)()
        self.put(0xE7FE)  # for ever
        return start

    def put(self, *codes):
        self.codes += codes

    def free(self):
        return self.rng.choice(FREE)

    def source(self):
        return self.rng.randrange(8)

    def bits(self, count):
        return self.rng.getrandbits(count)

    def filling(self):
        """Instructions that are jumped over."""
        count = self.rng.randrange(4)
        self.put(*(0xDE00 for _ in range(count)))
        return count

    def shift(self):
        self.put(self.rng.randrange(3) << 11 | self.bits(5) << 6 | self.source() << 3 | self.free())

    def add_or_subtract(self):
        self.put(0x1800 | self.bits(5) << 6 | self.source() << 3 | self.free())

    def with_number(self):
        self.put(0x2000 | self.bits(2) << 11 | self.free() << 8 | self.bits(8))

    def alu(self):
        self.put(0x4000 | self.bits(4) << 6 | self.source() << 3 | self.free())

    def any_register(self):
        """ADD, CMP and MOV with at least one register above R7."""
        target = self.rng.choice([*FREE, 8, 9, 10, 11, 12])
        source = self.rng.randrange(8, 16) if target < 8 else self.rng.randrange(16)
        self.put(0x4400 | self.rng.randrange(3) << 8 | target >> 3 << 7 | source << 3 | target & 7)

    def load_from_code(self):
        self.put(0x4800 | self.free() << 8 | self.bits(8))

    def index(self, size):
        """A free register with a multiple of `size`."""
        register = self.free()
        self.put(0x2000 | register << 8 | self.bits(8) // size * size)
        return register

    def indexed(self):
        operation, size = self.rng.choice(((0x5000, 4), (0x5400, 1), (0x5800, 4), (0x5C00, 1)))
        base = 7 if operation < 0x5800 else self.rng.choice(POINTERS)
        self.put(operation | self.index(size) << 6 | base << 3 | self.free())

    def signed(self):
        operation, size = self.rng.choice(((0x5200, 2), (0x5600, 1), (0x5A00, 2), (0x5E00, 2)))
        base = 7 if operation == 0x5200 else self.rng.choice(POINTERS)
        self.put(operation | self.index(size) << 6 | base << 3 | self.free())

    def near(self):
        loads = self.bits(1)
        base = self.rng.choice(POINTERS) if loads else 7
        self.put(0x6000 | self.bits(1) << 12 | loads << 11 | self.bits(5) << 6 | base << 3 | self.free())

    def half(self):
        loads = self.bits(1)
        base = self.rng.choice(POINTERS) if loads else 7
        self.put(0x8000 | loads << 11 | self.bits(5) << 6 | base << 3 | self.free())

    def stack_place(self):
        self.put(0x9000 | self.bits(1) << 11 | self.free() << 8 | self.bits(8))

    def address(self):
        self.put(0xA000 | self.bits(1) << 11 | self.free() << 8 | self.bits(8))

    def move_stack(self):
        self.put(0xB000 | self.bits(1) << 7 | self.bits(4))

    def list_of_free(self):
        return self.rng.randrange(1, 1 << len(FREE))

    def push(self):
        self.put(0xB400 | self.bits(1) << 8 | self.list_of_free())

    def pop(self):
        self.put(0xBC00 | self.list_of_free())

    def multiple(self):
        """The base is a free register, which may be in the list."""
        base, loads = self.free(), self.bits(1)
        pointer = self.rng.choice(POINTERS) if loads else 7
        self.put(0x1C00 | pointer << 3 | base, 0xC000 | loads << 11 | base << 8 | self.list_of_free())

    def branch_if(self):
        at = len(self.codes)
        self.put(0)
        skipped = self.filling_of_free_code()
        self.codes[at] = 0xD000 | self.rng.randrange(14) << 8 | (skipped - 1) & 0xFF

    def filling_of_free_code(self):
        before = len(self.codes)
        for _ in range(self.rng.randrange(3)):
            self.alu()
        return len(self.codes) - before

    def branch(self):
        at = len(self.codes)
        self.put(0)
        self.codes[at] = 0xE000 | (self.filling() - 1) & 0x7FF

    def bl(self, distance):
        """BL over `distance` instructions from its first one on."""
        offset = distance - 2
        self.put(0xF000 | offset >> 11 & 0x7FF, 0xF800 | offset & 0x7FF)

    def call(self):
        """A subroutine behind the call, which returns by POP or by BX."""
        body = [0xB500, 0xBD00] if self.bits(1) else [0x4770]
        self.bl(3)
        self.put(0xE000 | (len(body) - 1) & 0x7FF, *body)

    def call_back(self):
        """A subroutine in front of the call."""
        self.put(0xE000, 0x4770)
        self.bl(-1)

    def jump(self):
        """MOV PC, or BX to an odd address: over what is left of eight bytes."""
        register = self.free()
        if len(self.codes) % 2:
            self.put(0x46C0)  # MOV R8, R8
        self.put(0xA001 | register << 8)
        if self.bits(1):
            self.put(0x4687 | register << 3, 0xDE00, 0xDE00)
        else:
            self.put(0x3001 | register << 8, 0x4700 | register << 3, 0xDE00)

    def jump_by_sum(self):
        """ADD PC."""
        register, skipped = self.free(), self.rng.randrange(1, 4)
        self.put(0x2000 | register << 8 | (2 * skipped - 2), 0x4487 | register << 3, *[0xDE00] * skipped)


def registers_of(rng, start):
    value = lambda: rng.choice(TELLING) if rng.random() < 0.5 else rng.getrandbits(32)  # noqa: E731
    values = [value() for _ in range(16)]
    values[6] = DATA + 4 * rng.randrange(256, 512)
    values[7] = RAM + 4 * rng.randrange(64, 512)
    values[13] = RAM + 0x1000 + 4 * rng.randrange(64)
    values[15] = start
    return values


def make(rng, count):
    """The flash memory, and `count` cases, several for each program that fits into it."""
    writer = Writer(rng)
    starts = []
    while 2 * len(writer.codes) < DATA - 1024:
        starts.append(writer.program())
    code = struct.pack(f"<{len(writer.codes)}H", *writer.codes)
    flash = code + rng.randbytes(FLASH_SIZE - len(code))
    flags = (0, 8, 4, 2, 1, 3, 10, 9, 6, 5, 11, 7)  # never N and Z
    cases = []
    for _ in range(count):
        start = rng.choice(starts)
        cases.append(Case(registers_of(rng, start), rng.choice(flags) << 28, 2 * LENGTH))
    return flash, cases
