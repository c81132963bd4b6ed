"""Images for compare.py: random bytes, with a small program planted in every 1K, so that it runs whatever is mapped.

At a reset the program copies a loop to RAM and goes there. From then on each frame runs the slots of the loop, each of
them an instruction with an absolute address that the test has put there:

    LDA #value; instruction; STA result

The loop reaches the TIA by its mirror from $40 on, because some cartridges own $0000-$003F.
"""

import random

CHUNK = 1024
BOOT, SNIPPET, VECTORS = 0x280, 0x3D0, 0x3FC  # places in every 1K
SLOTS, SLOT_SIZE = 10, 7
NOP_ABSOLUTE = 0x0C
COUNTER = 0x60  # RAM index of the number of frames so far
RESULTS = 0x66  # RAM index of the first result; behind the loop and in front of the stack
LOOP = bytes(
    [
        0xA2,
        0x02,
        0x86,
        0x40,
        0x86,
        0x42,
        0x86,
        0x42,
        0xA2,
        0x00,
        0x86,
        0x40,  # VSYNC on, two lines, off
        0xE6,
        0x80 + COUNTER,
    ]
)
FIRST_SLOT = len(LOOP)


def loop_program():
    slots = b"".join(bytes([0xA9, 0, NOP_ABSOLUTE, 0x80, 0x00, 0x85, 0x80 + RESULTS + slot]) for slot in range(SLOTS))
    return LOOP + slots + bytes([0x4C, 0x80, 0x00])


def boot_program(origin):
    loop = loop_program()
    code = bytes([0x78, 0xD8, 0xA2, 0xFF, 0x9A, 0xA2, len(loop) - 1])  # SEI, CLD, stack, LDX #
    copy = len(code)
    source = origin + copy + 11
    code += bytes([0xBD, source & 0xFF, source >> 8, 0x95, 0x80, 0xCA, 0x10, 0xF8, 0x4C, 0x80, 0x00])  # copy, JMP $80
    return code + loop


def plant(image, at, data):
    image[at : at + len(data)] = data


def planted(size, rng):
    image = bytearray(rng.randbytes(size))
    for chunk in range(0, size - size % CHUNK, CHUNK):
        plant(image, chunk + BOOT, boot_program(0xFC00 + BOOT))
        plant(image, chunk + SNIPPET, [0xA9, chunk >> 10 & 0xFF, 0xE8, 0x60])  # LDA #chunk; INX; RTS
        plant(image, chunk + VECTORS, [BOOT & 0xFF, 0xFC + (BOOT >> 8)] * 2)
    return image


def with_ports(image, size):
    for bank in range(0, len(image), 4096):
        image[bank : bank + size] = bytes([image[bank]]) * size
    return image


def with_signature(image, *signatures):
    for number, signature in enumerate(signatures):
        plant(image, 0x140 + 0x10 * number, bytes.fromhex(signature))
    return image


def e7(image):
    image[0x3800:0x3A00] = bytes([0x5A]) * 0x200
    image[0x3A00] = 0xA5
    return image


def load(rng, number, configuration):
    """24 pages, which fill all three banks of RAM; it starts at the program."""
    start = 0xFC00 + BOOT
    header = bytes([start & 0xFF, start >> 8, configuration, 24, 0, number, 0, 0] + 8 * [0])
    header += bytes(page // 8 | page % 8 << 2 for page in range(24))
    return planted(8192, rng) + header.ljust(256, b"\0")


def ar(rng):
    """Load 0, which the BIOS starts, and one that the loop can request. Its first byte, at $80, is its
    number."""
    return load(rng, 0, 0x0D & ~2) + load(rng, LOOP[0], LOOP[0])


# Without CV in 2K, on which the reference crashes.
MAKERS = {
    "2K": lambda r: planted(2048, r),
    "4K": lambda r: planted(4096, r),
    "F8": lambda r: planted(8192, r),
    "F8SC": lambda r: with_ports(planted(8192, r), 256),
    "F6": lambda r: planted(16384, r),
    "F6SC": lambda r: with_ports(planted(16384, r), 256),
    "F4": lambda r: planted(32768, r),
    "F4SC": lambda r: with_ports(planted(32768, r), 256),
    "FASC": lambda r: planted(12288, r),
    "E0": lambda r: with_signature(planted(8192, r), "8DE01F"),
    "E7": lambda r: e7(planted(16384, r)),
    "FE": lambda r: with_signature(planted(8192, r), "2000D0C6C5"),
    "DPC": lambda r: planted(10240, r) + r.randbytes(255),
    "3F": lambda r: with_signature(planted(16384, r), "853F", "853F"),
    "3E": lambda r: with_signature(planted(16384, r), "853EA900"),
    "UA": lambda r: with_signature(planted(8192, r), "8D4002"),
    "CV 4K": lambda r: with_signature(planted(4096, r), "9900F4"),
    "AR": ar,
    "MB": lambda r: planted(65536, r),
    "MC": lambda r: planted(131072, r),
}

# Addresses with an effect, besides the whole cartridge.
LIVELY = {
    "E0": [(0x1FE0, 24)],
    "E7": [(0x1FE0, 12), (0x1000, 0x800), (0x1800, 0x200), (0x1FE7, 1)],
    "FE": [(0xD000, 0x1000)],
    "DPC": [(0x1000, 64), (0x1040, 64), (0x1000, 8), (0x1058, 8), (0x1FC0, 64)],
    "3F": [(0x0000, 64), (0x1000, 64), (0x1000, 0x1000)],
    "3E": [(0x0000, 64), (0x003E, 2), (0x003E, 2), (0x1000, 64), (0x103E, 2), (0x1400, 0x400)],
    "UA": [(0x0220, 1), (0x0240, 1), (0x0200, 128), (0xE220, 1)],
    "CV 4K": [(0x1000, 0x800)],
    "AR": [(0x1000, 0x100), (0x1FF8, 1), (0x1FF8, 1), (0x1850, 1)],
    "MB": [(0x1FF0, 1)],
    "MC": [(0x003C, 4), (0x003C, 4), (0x0000, 64), (0x1000, 0xC00), (0x1C00, 0x400), (0x1FFC, 2)],
}
# Cartridge RAM that can hold code: an address whose access selects it, write port, read port, size.
SC_PORTS = [(0x1FF9, 0x1000, 0x1080, 128)]
RAM_CODE = {
    "F8SC": SC_PORTS,
    "F6SC": SC_PORTS,
    "F4SC": SC_PORTS,
    "FASC": [(0x1FF9, 0x1000, 0x1100, 256)],
    "E7": [(0x1FE7, 0x1000, 0x1400, 1024), (0x1FE9, 0x1800, 0x1900, 256)],
    "3E": [(0x003E, 0x1400, 0x1000, 1024), (0x003E, 0x1400, 0x1400, 1024)],
    "CV 4K": [(0x1000, 0x1400, 0x1000, 1024)],
    "MC": [(0x003C, 0x1000, 0x1200, 512), (0x003D, 0x1400, 0x1600, 512)],
}
ATARI = [(0x1FF0, 16), (0x1FF4, 8), (0x1000, 0x200)]  # all others


def image(scheme, seed):
    return bytes(MAKERS[scheme](random.Random(f"{scheme} {seed}")))
