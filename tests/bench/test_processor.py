"""scripts/measure/processor.py: figures name the design of the processor, not only its brand."""

import processor
import pytest

CPUINFO = """processor\t: 0
vendor_id\t: {vendor}
cpu family\t: {family}
model\t\t: {model}
model name\t: A brand

processor\t: 1
model name\t: Another brand
"""


class TestProcessor:
    @pytest.mark.parametrize(
        "vendor, family, model, design",
        [
            ("AuthenticAMD", 25, 1, "Zen 3"),
            ("AuthenticAMD", 25, 17, "Zen 4"),
            ("AuthenticAMD", 26, 2, "Zen 5"),
            ("GenuineIntel", 6, 0x55, "Skylake-SP or Cascade Lake"),
        ],
    )
    def test_designs_that_share_a_brand_are_told_apart(self, vendor, family, model, design):
        text = CPUINFO.format(vendor=vendor, family=family, model=model)
        assert processor.describe(text) == f"A brand ({design})"

    def test_an_unknown_design_is_given_by_its_numbers(self):
        text = CPUINFO.format(vendor="GenuineIntel", family=6, model=1)
        assert processor.describe(text) == "A brand (family 6, model 1)"

    def test_a_description_without_a_name(self):
        assert processor.describe("processor\t: 0\nBogoMIPS\t: 50.00\n") is None

    def test_this_machine_has_a_name(self):
        assert processor.name()
