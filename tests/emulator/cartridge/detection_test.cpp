// Detection of cartridge schemes: docs/spec/cartridges.md, 2, and docs/spec/cartridges.md, "How to check", 1
// and 2.
#include <algorithm>
#include <catch2/catch.hpp>
#include <string>

#include "emulator/cartridge/cartridge.hpp"

namespace racebeam::test {
namespace {

using Bytes = std::vector<std::uint8_t>;

struct Patch {
  std::size_t at;
  Bytes bytes;
};

// Bytes without a signature, a repetition or a run.
Rom mixed(std::size_t size, std::initializer_list<Patch> patches = {}) {
  Rom rom(size);
  for (std::size_t i = 0; i < size; ++i)
    rom[i] = static_cast<std::uint8_t>(i * 7 + (i >> 8) * 3 + (i >> 12) * 17);
  for (const Patch& patch : patches)
    std::copy(patch.bytes.begin(), patch.bytes.end(), rom.begin() + static_cast<long>(patch.at));
  return rom;
}

Rom with_halves_equal(std::size_t size) {
  Rom rom = mixed(size);
  std::copy_n(rom.begin(), size / 2, rom.begin() + static_cast<long>(size / 2));
  return rom;
}

// An image whose banks have the same first 256 bytes.
Rom with_ram_ports(std::size_t size) {
  Rom rom = mixed(size);
  for (std::size_t bank = 0; bank < size; bank += 4096)
    std::fill_n(rom.begin() + static_cast<long>(bank), 256, bank >> 12);
  return rom;
}

struct Case {
  const char* what;
  Rom rom;
  std::string scheme;  // empty: none
};

void check(const std::vector<Case>& cases) {
  for (const Case& c : cases) {
    INFO(c.what);
    CHECK(std::string(scheme_name(c.rom)) == c.scheme);
  }
}

TEST_CASE("The size decides where no signature does") {
  for (const auto& [size, scheme] : {std::pair<std::size_t, const char*>{2048, "2K"},
                                     {4096, "4K"},
                                     {8192, "F8"},
                                     {16384, "F6"},
                                     {32768, "F4"},
                                     {8448, "AR"},
                                     {16896, "AR"},
                                     {10240, "DPC"},
                                     {10495, "DPC"},
                                     {10496, "DPC"},
                                     {12288, "FASC"},
                                     {65536, "MB"},
                                     {131072, "MC"},
                                     {5000, ""},
                                     {0, ""}}) {
    INFO(size << " bytes");
    CHECK(scheme_name(mixed(size)) == scheme);
  }
}

TEST_CASE("Halves, RAM ports and constant bytes") {
  check({{"4096 zero bytes", Rom(4096), "2K"},
         {"8192 zero bytes", Rom(8192), "F8SC"},
         {"4K with equal halves", with_halves_equal(4096), "2K"},
         {"8K with equal halves", with_halves_equal(8192), "4K"},
         {"8K with RAM ports", with_ram_ports(8192), "F8SC"},
         {"16K with RAM ports", with_ram_ports(16384), "F6SC"},
         {"32K with RAM ports", with_ram_ports(32768), "F4SC"},
         {"one bank's port is not constant",
          [] {
            Rom r = with_ram_ports(8192);
            r[4096 + 255] ^= 1;
            return r;
          }(),
          "F8"},
         {"only 255 bytes are looked at beyond the first",
          [] {
            Rom r = with_ram_ports(8192);
            r[256] = 0x5A;
            return r;
          }(),
          "F8SC"}});
}

TEST_CASE("Every signature is found") {
  check({{"E0, 1", mixed(8192, {{700, {0x8D, 0xE0, 0x1F}}}), "E0"},
         {"E0, 2", mixed(8192, {{700, {0x8D, 0xE0, 0x5F}}}), "E0"},
         {"E0, 3", mixed(8192, {{700, {0x8D, 0xE9, 0xFF}}}), "E0"},
         {"E0, 4", mixed(8192, {{700, {0xAD, 0xE9, 0xFF}}}), "E0"},
         {"E0, 5", mixed(8192, {{700, {0xAD, 0xED, 0xFF}}}), "E0"},
         {"E0, 6", mixed(8192, {{700, {0xAD, 0xF3, 0xBF}}}), "E0"},
         {"FE, 1", mixed(8192, {{700, {0x20, 0x00, 0xD0, 0xC6, 0xC5}}}), "FE"},
         {"FE, 2", mixed(8192, {{700, {0x20, 0xC3, 0xF8, 0xA5, 0x82}}}), "FE"},
         {"FE, 3", mixed(8192, {{700, {0xD0, 0xFB, 0x20, 0x73, 0xFE}}}), "FE"},
         {"FE, 4", mixed(8192, {{700, {0x20, 0x00, 0xF0, 0x84, 0xD6}}}), "FE"},
         {"UA", mixed(8192, {{700, {0x8D, 0x40, 0x02}}}), "UA"},
         {"3E in 8K", mixed(8192, {{700, {0x85, 0x3E, 0xA9, 0x00}}}), "3E"},
         {"3E in 16K", mixed(16384, {{700, {0x85, 0x3E, 0xA9, 0x00}}}), "3E"},
         {"3E in any size", mixed(6144, {{700, {0x85, 0x3E, 0xA9, 0x00}}}), "3E"},
         {"3F in 32K", mixed(32768, {{700, {0x85, 0x3F}}, {800, {0x85, 0x3F}}}), "3F"},
         {"3F in 64K", mixed(65536, {{700, {0x85, 0x3F}}, {800, {0x85, 0x3F}}}), "3F"},
         {"3F in any size", mixed(6144, {{700, {0x85, 0x3F}}, {800, {0x85, 0x3F}}}), "3F"},
         {"CV in 2K", mixed(2048, {{700, {0x9D, 0xFF, 0xF3}}}), "CV"},
         {"CV in 4K", mixed(4096, {{700, {0x99, 0x00, 0xF4}}}), "CV 4K"},
         {"E7",
          [] {
            Rom r = mixed(16384);
            std::fill_n(r.begin() + 0x3800, 0x200, 0xFF);
            return r;
          }(),
          "E7"}});
}

TEST_CASE("The first test that fits wins") {
  const Patch e0{700, {0x8D, 0xE0, 0x1F}}, ua{800, {0x8D, 0x40, 0x02}},
      fe{900, {0x20, 0x00, 0xD0, 0xC6, 0xC5}}, three_e{1000, {0x85, 0x3E, 0xA9, 0x00}},
      f1{1100, {0x85, 0x3F}}, f2{1200, {0x85, 0x3F}};
  check({{"E0 before 3E", mixed(8192, {e0, three_e}), "E0"},
         {"3E before 3F", mixed(8192, {three_e, f1, f2}), "3E"},
         {"3F before UA", mixed(8192, {f1, f2, ua}), "3F"},
         {"UA before FE", mixed(8192, {ua, fe}), "UA"},
         {"8K signatures mean nothing in 16K", mixed(16384, {e0, ua, fe}), "F6"}});
}

TEST_CASE("The search misses the last place, and skips a byte after each hit") {
  check({{"E0 ending at the last byte but one", mixed(8192, {{8188, {0x8D, 0xE0, 0x1F}}}), "E0"},
         {"E0 ending at the last byte", mixed(8192, {{8189, {0x8D, 0xE0, 0x1F}}}), "F8"},
         {"3F, 2 bytes on", mixed(8192, {{100, {0x85, 0x3F}}, {102, {0x85, 0x3F}}}), "F8"},
         {"3F, 3 bytes on", mixed(8192, {{100, {0x85, 0x3F}}, {103, {0x85, 0x3F}}}), "3F"},
         {"3F once", mixed(8192, {{100, {0x85, 0x3F}}}), "F8"}});
}

TEST_CASE("An unsuitable image is refused with the reason") {
  CHECK_THROWS_WITH(scheme_of(mixed(5000)), Catch::Contains("5000") && Catch::Contains("4096"));
  CHECK_THROWS_AS(scheme_of(Rom{}), std::invalid_argument);
  CHECK_THROWS_WITH(scheme_of(mixed(4096), "F9"),
                    Catch::Contains("scheme F9 is not known") && Catch::Contains("F8"));
  CHECK_THROWS_WITH(scheme_of(mixed(8192), "0840"), Catch::Contains("scheme 0840 is not implemented"));
}

// An image with `text` at three places.
Rom with_text(std::size_t size, const std::string& text) {
  const Bytes bytes(text.begin(), text.end());
  return mixed(size, {{700, bytes}, {1700, bytes}, {size - 8, bytes}});
}

TEST_CASE("An image with the text of a scheme that is not implemented is refused by that scheme's name") {
  struct {
    std::size_t size;
    const char *text, *scheme;
  } const kTexts[] = {
      {32768, "DPC+", "DPC+"}, {29 * 1024, "DPC+", "DPC+"}, {32768, "CDF", "CDF"},   {65536, "CDF", "CDF"},
      {65536, "EFEF", "EF"},   {65536, "EFSC", "EFSC"},     {131072, "DFDF", "DF"},  {131072, "DFSC", "DFSC"},
      {262144, "BFBF", "BF"},  {262144, "BFSC", "BFSC"},    {16384, "TJ3E", "3E+"},  {32768, "TJ3E", "3E+"},
      {32768, "MDMC", "MDM"},  {65536, "MDMC", "MDM"},      {32768, "LENIN", "CTY"}, {32768, "BUS", "BUS"},
  };
  for (const auto& [size, text, scheme] : kTexts) {
    INFO(text << " in " << size << " bytes");
    const Rom rom = with_text(size, text);
    CHECK_THROWS_WITH(scheme_of(rom), Catch::Contains("scheme " + std::string(scheme) + ", which is not"));
    CHECK(scheme_of(rom, "3F").name == "3F");  // who names a scheme knows better
  }
  CHECK(scheme_of(mixed(32768, {{700, {'C', 'D', 'F'}}})).name == "F4");
}

// Code that selects `count` banks.
Rom with_accesses(std::size_t size, unsigned first, unsigned step, unsigned count) {
  Rom rom = mixed(size);
  for (unsigned bank = 0; bank < count; ++bank) {
    const unsigned address = first + bank * step;
    const Bytes code = {0xAD, static_cast<std::uint8_t>(address), static_cast<std::uint8_t>(address >> 8)};
    std::copy(code.begin(), code.end(), rom.begin() + 4096L * bank + 300);
  }
  return rom;
}

TEST_CASE("An image of 64K or 128K that accesses the hot spots of another scheme is refused by its name") {
  const auto refused = [](const Rom& rom, const std::string& scheme) {
    CHECK_THROWS_WITH(scheme_of(rom), Catch::Contains("scheme " + scheme + ", which is not"));
  };
  refused(with_accesses(65536, 0x1FE0, 1, 16), "EF");
  refused(with_accesses(65536, 0xFFE0, 1, 4), "EF");
  refused(with_accesses(65536, 0x080D, 16, 16), "X07");
  refused(with_accesses(131072, 0x1FC0, 1, 32), "DF");
  refused(with_accesses(131072, 0xFFC0, 1, 8), "DF");
  CHECK(scheme_of(with_accesses(65536, 0xFFE0, 1, 3)).name == "MB");
  CHECK(scheme_of(with_accesses(65536, 0x1FF0, 0, 16)).name == "MB");
  CHECK(scheme_of(with_accesses(131072, 0xFFC0, 1, 7)).name == "MC");
}

TEST_CASE("A scheme that is asked for goes before the detected one, if the image is large enough") {
  for (const std::string_view name : scheme_names()) {
    INFO(name);
    CHECK(scheme_of(mixed(131072), name).name == name);
    const unsigned least = scheme_of(mixed(131072), name).image;
    CHECK(scheme_of(mixed(least), name).name == name);
    CHECK_THROWS_WITH(scheme_of(mixed(least - 1), name),
                      Catch::Contains(std::string(name)) && Catch::Contains(std::to_string(least)));
  }
}

}  // namespace
}  // namespace racebeam::test
