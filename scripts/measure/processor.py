"""The processor of this machine by name. Ratios differ between processors, so that every figure needs it."""

import pathlib
import platform
import re

# /proc/cpuinfo often gives only the brand. Family and model tell the design (the vendors' manuals).
_DESIGNS = [  # vendor, family, models, design
    ("AuthenticAMD", 23, range(0x00, 0x30), "Zen"),
    ("AuthenticAMD", 23, range(0x30, 0x100), "Zen 2"),
    ("AuthenticAMD", 25, range(0x00, 0x10), "Zen 3"),
    ("AuthenticAMD", 25, range(0x20, 0x60), "Zen 3"),
    ("AuthenticAMD", 25, range(0x10, 0x20), "Zen 4"),
    ("AuthenticAMD", 25, range(0x60, 0x100), "Zen 4"),
    ("AuthenticAMD", 26, range(0x00, 0x100), "Zen 5"),
    ("GenuineIntel", 6, (0x55,), "Skylake-SP or Cascade Lake"),
    ("GenuineIntel", 6, (0x6A, 0x6C), "Ice Lake-SP"),
    ("GenuineIntel", 6, (0x8F, 0xCF), "Sapphire Rapids or Emerald Rapids"),
]


def describe(cpuinfo):
    """The name in a text like /proc/cpuinfo, with the design where it is known: 'AMD EPYC (Zen 3)'. None: no name."""
    facts = dict(re.findall(r"^([^\t:]+?)\s*: (.*)$", cpuinfo.split("\n\n")[0], re.M))
    if "model name" not in facts:
        return None
    family, model = int(facts.get("cpu family", 0)), int(facts.get("model", 0))
    for vendor, of_family, models, design in _DESIGNS:
        if facts.get("vendor_id") == vendor and family == of_family and model in models:
            return f"{facts['model name']} ({design})"
    return f"{facts['model name']} (family {family}, model {model})"


def name():
    return describe(pathlib.Path("/proc/cpuinfo").read_text()) or platform.machine()
