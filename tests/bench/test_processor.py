"""scripts/measure/processor.py and cartridges.py: figures name the design of the processor, and what was played."""

import re

import cartridges
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


class TestCartridges:
    def test_beamfall_stands_for_an_image_that_is_missing(self, tmp_path, monkeypatch):
        (tmp_path / "pong.bin").write_bytes(b"an image")
        monkeypatch.setenv("RACEBEAM_ROMS", str(tmp_path))
        names = [cartridges.name_of(cartridges.image_or_own(game)) for game in ("pong", "seaquest", "updraft")]
        assert names == ["pong", "beamfall", "updraft"]

    def test_tools_share_helpers_without_importing_each_other(self):
        shared = {"bench_picture", "bench_report", "bench_settings", "bench_sides"}
        for path in (cartridges.ROOT / "scripts/measure").glob("bench_*.py"):
            imports = re.findall(r"^(?:import|from) (bench_\w+)", path.read_text(), re.MULTILINE)
            assert set(imports) <= shared, path.name
