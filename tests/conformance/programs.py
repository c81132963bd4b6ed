"""Cartridge images with random programs, in most schemes. Each kind of program is the game of a run, such as
`tame_program:seed=7`, and the seed determines the image.

Without MC, whose block numbers the reference leaves to chance, and without AR, whose BIOS differs.
"""

import random

# Size, ports of RAM at the start of each bank, signature (docs/spec/cartridges.md, 2).
SCHEMES = [
    (2048, 0, ""),
    (4096, 0, ""),
    (8192, 0, ""),
    (8192, 256, ""),
    (8192, 0, "8DE01F"),
    (8192, 0, "853EA900"),
    (8192, 0, "853F00853F"),
    (8192, 0, "8D4002"),
    (8192, 0, "2000D0C6C5"),
    (10240, 0, ""),
    (12288, 0, ""),
    (16384, 0, ""),
    (16384, 256, ""),
    (32768, 0, ""),
    (32768, 256, ""),
    (65536, 0, ""),
    (4096, 0, "9900F4"),
]
SIGNATURE_AT = 0x140
GZIP = bytes.fromhex("1F8B")
VECTORS_EVERY = 1024  # any slice of a bank may hold the vectors

TIM1T, INTIM = 0x0294, 0x0284
LDA_ABSOLUTE, STA_ABSOLUTE, JMP, BNE, NOP = 0xAD, 0x8D, 0x4C, 0xD0, 0xEA
STA, STX = 0x85, 0x86
WSYNC, HMP0, HMM0, HMOVE = 0x02, 0x20, 0x22, 0x2A
SCENE = bytes.fromhex("06070809041B1C1D1E1F")  # colours, NUSIZ0, graphics, and what enables missiles and the ball
STROBES = bytes.fromhex("040A1011121314222528292A2B1B")  # and other registers that move an object or change its shape
SLIDE_AT = 0x40
FREQUENT = bytes.fromhex("A9A2A0A5B5BDB9B185868495999D918D69C9E6C6CA882060")
BOOT, POINTER = 0xFE00, 0xC0  # of spot_program(); each slice has the code that begins at BOOT
SPOT_LOOP = bytes.fromhex(
    "A2FF9AD8E6F0"  # the stack; $F0 counts the turns
    "A5F02903D00CA902854085428542A9008540"  # each fourth one ends a frame
    "AD8002C9FFF0E1"  # nothing else until the joystick is moved
    "A5F10A693565F085F185F2"  # $F1 is random, and the lower half of the address
    "A5F04A45F1292F09D085F3"  # the upper half
    "24F1100AA9FF85F3A5F209C085F2"  # or from $FFC0 on
    "6CF200"
)
IDIOMS = [
    bytes.fromhex(text)
    for text in (
        "AD8402D0FB",
        "AE840210FB",
        "2C850210FB",  # wait for the timer
        "A9208D9602",
        "A9908D9502",
        "A9308D9702",
        "A9538D9702",  # TIM64T, TIM8T, T1024T
        "A90285008502A9008500",
        "A9028500850285028502A90085008501",  # a frame ends
        "A2088502CAD0FB",
        "A01484028409841B8810F7",  # lines
        "A2FF9AD8",
        "A21F9A68684848",  # the stack in RAM, and in the TIA
        "F8",
        "F86937E919",
        "D8",
        "A9A58590A9608592209000",
        "A9E685A0A9B085A1A94C85A24CA000",
    )
]


def length_of(opcode):
    column, odd_row = opcode & 15, opcode & 16
    if opcode in (0x00, 0x40, 0x60) or column in (8, 10):
        return 1
    return 3 if opcode == 0x20 or column >= 12 or odd_row and column in (9, 11) else 2


def address(rng):
    kind = rng.random()
    if kind < 0.3:
        plain = 0x1000 | rng.randrange(0x1000)
    elif kind < 0.45:
        plain = rng.choice([0x1FE0 | rng.randrange(0x20), 0x1000 | rng.randrange(0x100)])  # hot spots, ports
    elif kind < 0.65:
        plain = 0x0280 | rng.randrange(0x20)
    elif kind < 0.75:
        plain = 0x0180 | rng.randrange(0x80)
    else:
        plain = rng.choice([0, 0x40, 0x140]) | rng.randrange(0x40)
    return plain | rng.randrange(8) << 13


def instruction(rng):
    opcode = rng.choice(FREQUENT) if rng.random() < 0.4 else rng.randrange(256)
    if opcode & 31 == 18 and rng.random() < 0.98:
        opcode = NOP  # else it would halt the CPU
    length = length_of(opcode)
    if length == 1:
        return [opcode]
    if length == 3:
        jumps = opcode in (0x20, JMP)
        target = 0xF040 | rng.randrange(0x1000) if jumps and rng.random() < 0.97 else address(rng)
        return [opcode, target & 255, target >> 8]
    if opcode & 31 == 16:
        return [opcode, rng.choice([rng.randrange(24), 254 - rng.randrange(24), rng.randrange(256)])]
    return [opcode, rng.choice([0x80 | rng.randrange(128), rng.randrange(64), rng.randrange(256)])]


def plant(image, at, data):
    room = image[at : at + len(data)]
    image[at : at + len(data)] = data[: len(room)]


def halts(opcode):
    return opcode & 31 in (2, 18) and opcode not in (0x82, 0xA2, 0xC2, 0xE2)


def plant_vectors(image, rng):
    for end in range(VECTORS_EVERY, len(image) + 1, VECTORS_EVERY):
        for at in range(end - 6, end, 2):
            start = 0x1000 | rng.randrange(0x1000) | rng.randrange(8) << 13
            plant(image, at, [start & 255, start >> 8])


def random_program(rng, size):
    """All bytes are random: it soon runs in RAM and in the TIA."""
    image = bytearray(rng.randbytes(size))
    plant_vectors(image, rng)
    return image


def tame_program(rng, size):
    """Random instructions whose operands mostly make sense, and idioms of games."""
    image = bytearray()
    while len(image) < size:
        image += bytes(instruction(rng))
    del image[size:]
    for _ in range(rng.randrange(60)):
        plant(image, rng.randrange(size), rng.choice(IDIOMS))
    plant_vectors(image, rng)
    return image


def ram_program(rng, size):
    """Copies random bytes to RAM and runs them, on into the TIA's addresses and back. Most frames end there."""
    code = bytearray(rng.randbytes(128))
    for at, opcode in enumerate(code):
        if halts(opcode):
            code[at] = NOP
    boot = bytes.fromhex("A27FBD00F29580CA10F8A900A2FFA0009A4C8000")  # copies from $F200, jumps to $0080
    bank = bytearray([NOP] * 4096)
    plant(bank, 0, boot)
    plant(bank, 0x200, code)
    after_brk = rng.choice([0xF000, 0x0080, 0x0080 | rng.randrange(128), rng.randrange(128)])
    plant(bank, 0xFFC, [0x00, 0xF0, after_brk & 255, after_brk >> 8])
    return bank


def spot(rng):
    """Addresses that do something in a scheme."""
    if rng.random() < 0.3:
        return rng.choice([0x0220, 0x0240, 0x003E, 0x003F, 0x1400 | rng.randrange(0x400), 0x1FF4 | rng.randrange(8)])
    return address(rng)


def reached(rng, place):
    """Code that accesses an address with any instruction that can, indexed or through the pointer at $C0."""
    index, column = rng.randrange(256), rng.choice([1, 3, 12, 13, 14, 15, 17, 19, 25, 27, 28, 29, 30, 31])
    opcode = rng.randrange(8) << 5 | column
    base = place if column < 16 else place - index & 0xFFFF
    low, high = base & 255, base >> 8
    registers = [0xA2, index, 0xA0, index]
    if column in (1, 3, 17, 19):
        operand = POINTER - index & 255 if column < 16 else POINTER
        return [0xA9, low, STA, POINTER, 0xA9, high, STA, POINTER + 1, *registers, opcode, operand]
    return [] if opcode in (JMP, 0x6C) else [*registers, opcode, low, high]


def spot_operation(rng):
    kind = rng.random()
    if kind < 0.6:
        return reached(rng, spot(rng)) + [0x86, 0xC4, 0x45, 0xC5, STA, 0xC5]
    if kind < 0.7:
        return [rng.choice([0xF8, 0xD8]), rng.choice([0x69, 0xE9, 0x6B]), rng.randrange(256), 0x08, 0x68, STA, 0xC6]
    if kind < 0.8:
        return [0xA2, rng.randrange(256), 0x9A, *rng.choices([0x48, 0x08, 0x68, 0x28, 0xBA], k=3), 0x86, 0xC7]
    return [rng.choice([0x10, 0x30, 0x50, 0x70, 0x90, 0xB0, BNE, 0xF0]), rng.randrange(7)]


def spot_program(rng, size):
    """A loop that is copied to RAM jumps into the cartridge, half of the times near its end. The code there reaches
    hot spots in all ways, also by running across them, and goes back to where the loop is copied."""
    image = bytearray()
    while len(image) < size:
        for _ in range(rng.randrange(1, 6)):
            image += bytes(spot_operation(rng))
        image += bytes([NOP, NOP, JMP, BOOT & 255, BOOT >> 8])
    del image[size:]
    for at, opcode in enumerate(image):
        if halts(opcode):
            image[at] = NOP
    copies = bytes([0xA2, len(SPOT_LOOP) - 1, 0xBD, BOOT + 13 & 255, BOOT + 13 >> 8, 0x95, 0x80, 0xCA, 0x10, 0xF8])
    for slice_at in range(0, size, VECTORS_EVERY):
        plant(image, slice_at + BOOT % VECTORS_EVERY, copies + bytes([JMP, 0x80, 0x00]) + SPOT_LOOP)
        plant(image, slice_at + VECTORS_EVERY - 4, [BOOT & 255, BOOT >> 8] * 2)
    return image


def row_program(rng, size):
    """Waits for the timer, then runs a row of code without a jump, and counts the turns. No frame closes, so
    each ends after 25,000 instructions."""
    bank = [
        0xA9,
        rng.randrange(1, 256),
        STA_ABSOLUTE,
        TIM1T & 255 | rng.randrange(4),
        TIM1T >> 8,
        LDA_ABSOLUTE,
        INTIM & 255,
        INTIM >> 8,
        BNE,
        0xFB,
    ]
    bank += [NOP] * rng.randrange(size - 128)
    bank += [0xE6, 0xA0, BNE, 0x02, 0xE6, 0xA1, JMP, 0x00, 0xF0]  # counts at $A0
    return bytearray(bank).ljust(size - 6, bytes([NOP])) + bytes([0x00, 0xF0] * 3)


def delay(cycles):
    """Code that takes this many cycles, two or more."""
    return [0xC5, 0x80] * (cycles % 2) + [NOP] * ((cycles - 3 * (cycles % 2)) // 2)


def moving_lines(rng, page):
    """256 bytes of code that shows some lines. On each, an HMOVE follows at a cycle that depends on $80, the
    number of the frame, and then strobes follow. In half of them, missile 0 gets into its Cosmic Ark mode."""
    cosmic, mask = rng.random() < 0.5, rng.choice([0, 7, 15, 31, 63])
    entry = SLIDE_AT | rng.randrange(64) & ~mask
    motions = [(HMM0, 0x70)] if cosmic else [(HMP0 + rng.randrange(5), rng.randrange(256)) for _ in range(3)]
    code = [0xA9, rng.randrange(1, 12), STA, 0x84, 0xA2, 0x60]
    again = len(code)
    code += [byte for register, value in motions for byte in (0xA9, value, STA, register)]
    code += [0xA5, 0x80, 0x29, mask, 0x09, entry, STA, 0x82, 0xA9, page, STA, 0x83, STA, WSYNC, 0x6C, 0x82, 0x00]
    code += [NOP] * (SLIDE_AT - len(code)) + [0xC9] * 62 + [0xC5, NOP]  # a cycle less from each later entry on
    code += [STA, HMOVE] + (delay(18) + [STX, HMM0]) * cosmic
    for _ in range(rng.randrange(5)):
        value = [0xA9, rng.choice([0, 2, 0x10, 0x60, 0x70, 0xFF])] * (rng.random() < 0.5)
        code += delay(rng.randrange(2, 20)) + value + [STA, rng.choice(STROBES)]
    code += [0xC6, 0x84, 0xF0, 0x03, JMP, again, page]  # the next line
    code += [0xA2, rng.randrange(1, 9), STA, WSYNC, 0xCA, BNE, 0xFB, STA, rng.choice(STROBES)]
    return code + [NOP] * (256 - len(code))


def moving_program(rng, size):
    """Frames whose lines move objects. See moving_lines()."""
    code = [0xE6, 0x80, 0xA9, 0x02, STA, 0x00, STA, WSYNC, STA, WSYNC, STA, WSYNC, 0xA9, 0x00, STA, 0x00, STA, 0x01]
    for register in (*SCENE, *rng.sample(STROBES, 4)):
        code += [0xA9, rng.choice([0x02, 0x13, 0x35, 0xFF, rng.randrange(256)]), STA, register]
    code += [0xA2, rng.choice([10, 36]), STA, WSYNC, 0xCA, BNE, 0xFB]
    bank = bytearray(code).ljust(256, bytes([NOP]))
    pages = rng.randrange(3, 12)
    for page in range(0xF1, 0xF1 + pages):
        bank += bytes(moving_lines(rng, page))
    bank += bytes([0xA2, rng.choice([1, 30, 100]), STA, WSYNC, 0xCA, BNE, 0xFB, JMP, 0x00, 0xF0])
    return bank.ljust(size - 6, bytes([NOP])) + bytes([0x00, 0xF0] * 3)


KINDS = {
    maker.__name__: maker
    for maker in (random_program, tame_program, ram_program, spot_program, row_program, moving_program)
}
OF_4K = ("row_program", "ram_program", "moving_program")


def image_of(kind, seed):
    rng = random.Random(f"{kind} {seed}")
    if kind in OF_4K:
        return bytes(KINDS[kind](rng, 4096))
    size, ports, signature = rng.choice(SCHEMES)
    image = KINDS[kind](rng, size)
    if ports:
        for bank in range(0, size, 4096):
            image[bank : bank + ports] = bytes([image[bank]]) * ports
    plant(image, SIGNATURE_AT, bytes.fromhex(signature))
    if image.startswith(GZIP):
        image[0] = NOP  # both sides would decompress the image, and the reference crashes on damaged data
    return bytes(image)
