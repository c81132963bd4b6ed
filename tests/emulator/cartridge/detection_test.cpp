// Detection of cartridge schemes: docs/spec/cartridges.md, 2, and docs/spec/cartridges.md, "How to check", 1
// and 2.
#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <random>
#include <set>
#include <string>
#include <tuple>

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

// An image whose banks begin with 128 bytes that are not all equal, twice.
Rom with_repeated_ports(std::size_t size) {
  Rom rom = mixed(size);
  for (auto bank = rom.begin(); bank != rom.end(); bank += 4096) std::copy_n(bank, 128, bank + 128);
  return rom;
}

Rom marked_sc(Rom rom) {
  rom[rom.size() - 6] = 'S';
  rom[rom.size() - 5] = 'C';
  return rom;
}

TEST_CASE("RAM ports show by their contents, too, which repeat in each bank") {
  Rom in_one_bank = mixed(8192), pattern = mixed(8192), almost = with_repeated_ports(8192);
  std::copy_n(in_one_bank.begin(), 128, in_one_bank.begin() + 128);
  almost[4096 + 255] ^= 1;
  for (std::size_t i = 0; i < pattern.size(); ++i) pattern[i] = static_cast<std::uint8_t>(i % 64 + i / 4096);
  Rom padded = with_repeated_ports(16384);  // without the ports, this would be E7
  std::fill_n(padded.begin() + 0x3800, 0x200, 0xFF);
  check({{"4K", with_repeated_ports(4096), "4KSC"},
         {"8K", with_repeated_ports(8192), "F8SC"},
         {"16K", with_repeated_ports(16384), "F6SC"},
         {"32K", with_repeated_ports(32768), "F4SC"},
         {"16K, padded", padded, "F6SC"},
         {"only the first bank", in_one_bank, "F8"},
         {"a pattern of 64 bytes", pattern, "F8"},
         {"but for one byte", almost, "F8"},
         {"4K, equal bytes", with_ram_ports(4096), "4K"},
         {"4K, equal bytes, marked", marked_sc(with_ram_ports(4096)), "4KSC"},
         {"4K, marked only", marked_sc(mixed(4096)), "4K"},
         {"4K with equal halves", with_halves_equal(4096), "2K"}});
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
                    Catch::Contains("unknown cartridge scheme 'F9'") && Catch::Contains("F8"));
  CHECK_THROWS_WITH(scheme_of(mixed(8192), "GL"), Catch::Contains("unsupported cartridge scheme 'GL'"));
}

TEST_CASE("A scheme whose image has one size refuses another, which the image's text shows") {
  const auto refusal = [](const Rom& rom) {
    try {
      scheme_of(rom);
    } catch (const std::exception& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(refusal(mixed(65536, {{372, {'C', 'D', 'F', 'J', 'C', 'D', 'F', 'J'}}})) ==
        "the cartridge scheme CDFJ needs an image of at most 32768 bytes; this one has 65536 bytes");
  CHECK(refusal(mixed(16384, {{372, {'C', 'D', 'F', 'J', 'C', 'D', 'F', 'J'}}})) ==
        "the cartridge scheme CDFJ needs an image of at least 32768 bytes; this one has 16384 bytes");
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
      {32768, "LENIN", "CTY"},
      {32768, "BUS", "BUS"},
  };
  for (const auto& [size, text, scheme] : kTexts) {
    INFO(text << " in " << size << " bytes");
    const Rom rom = with_text(size, text);
    CHECK_THROWS_WITH(scheme_of(rom), Catch::Contains("scheme " + std::string(scheme) + ", which is not"));
    CHECK(scheme_of(rom, "3F").name == "3F");  // who names a scheme knows better
  }
  CHECK(scheme_of(mixed(32768, {{700, {'C', 'D', 'F'}}})).name == "F4");
  CHECK(scheme_of(mixed(32768, {{700, {'C', 'D', 'F'}}, {5700, {'C', 'D', 'F'}}})).name == "F4");
}

TEST_CASE("ELF shows by its first bytes, and is refused, and WDSW shows by its size") {
  for (const std::size_t size : {4096U, 8192U, 32768U, 65536U, 100000U}) {
    CHECK_THROWS_WITH(scheme_of(mixed(size, {{0, {0x7F, 'E', 'L', 'F'}}, {700, {'D', 'P', 'C', '+'}}})),
                      Catch::Contains("scheme ELF, which is not"));
  }
  CHECK(scheme_name(mixed(8192, {{1, {0x7F, 'E', 'L', 'F'}}})) == "F8");
  CHECK(scheme_of(mixed(8195)).name == "WDSW");
}

TEST_CASE("Schemes are found by the text that their tools write") {
  check({{"EF", with_text(65536, "EFEF"), "EF"},
         {"EFSC", with_text(65536, "EFSC"), "EFSC"},
         {"DF", with_text(131072, "DFDF"), "DF"},
         {"DFSC", with_text(131072, "DFSC"), "DFSC"},
         {"BF", with_text(262144, "BFBF"), "BF"},
         {"BFSC", with_text(262144, "BFSC"), "BFSC"},
         {"EF's text in a larger image", with_text(131072, "EFEF"), "MC"},
         {"3E+", with_text(32768, "TJ3E"), "3E+"},
         {"3EX", with_text(32768, "3EX"), "3EX"},
         {"MDM", with_text(65536, "MDMC"), "MDM"},
         {"4A50", mixed(65536, {{65530, {0x50, 0x4A}}}), "4A50"},
         {"CDFJ", with_text(32768, "CDFJ"), "CDFJ"},
         {"CDFJ once, CDF twice", mixed(32768, {{700, {'C', 'D', 'F', 'J'}}, {900, {'C', 'D', 'F'}}}), "CDF"},
         {"CDF", with_text(32768, "CDF\x01"), "CDF"},
         {"CDF, version 0", with_text(32768, std::string("CDF\0", 4)), "CDF0"},
         {"CDFJ+", with_text(32768, "PLUSCDFJ"), "CDFJ+"},
         {"CDFJ+ of 512K", with_text(524288, "PLUSCDFJ"), "CDFJ+"},
         {"DPC+", with_text(32768, "DPC+"), "DPC+"},
         {"DPC+ without a driver", with_text(29696, "DPC+"), "DPC+"}});
}

TEST_CASE("A text counts in images of the least size of its scheme, and not in smaller ones") {
  struct {
    std::size_t size, smaller;
    std::string text;
    const char *scheme, *otherwise;
  } const kTexts[] = {
      {8192, 4096, "DPC+", "DPC+", "4K"},   {8192, 4096, "PLUSCDFJ", "CDFJ+", "4K"},
      {8192, 4096, "CDFJ", "CDFJ", "4K"},   {8192, 4096, {"CDF\0", 4}, "CDF0", "4K"},
      {8192, 4096, "CDF", "CDF", "4K"},     {8192, 4096, "3EX", "3EX", "4K"},
      {8192, 4096, "MDMC", "MDM", "4K"},    {8192, 4096, "\x8D\xF8\xFF\x8D\xFC\xFF", "FC", "4K"},
      {32768, 16384, "BUS", "BUS", "F6"},   {32768, 16384, "LENIN", "CTY", "F6"},
      {65536, 32768, "EFEF", "EF", "F4"},   {65536, 32768, "EFSC", "EFSC", "F4"},
      {131072, 65536, "DFDF", "DF", "MB"},  {131072, 65536, "DFSC", "DFSC", "MB"},
      {262144, 131072, "BFBF", "BF", "MC"}, {262144, 131072, "BFSC", "BFSC", "MC"},
  };
  for (const auto& [size, smaller, text, scheme, otherwise] : kTexts) {
    INFO(text << " in " << size << " bytes");
    CHECK(scheme_name(with_text(size, text)) == scheme);
    CHECK(scheme_name(with_text(smaller, text)) == otherwise);
  }
  CHECK(scheme_name(mixed(2048, {{700, {'T', 'J', '3', 'E'}}})) == "3E+");
  CHECK(scheme_name(with_text(262144, "DFDF")).empty());
  CHECK(scheme_name(with_text(524288, "BFBF")).empty());
  CHECK(scheme_name(mixed(65536, {{65530, {0x4A, 0x50}}})) == "MB");
  CHECK(scheme_name(mixed(32768, {{32762, {0x50, 0x4A}}})) == "F4");
}

TEST_CASE("Texts that must be there twice are less than 4096 bytes apart") {
  const Bytes text = {'3', 'E', 'X'};
  CHECK(scheme_name(mixed(8192, {{700, text}, {700 + 4095, text}})) == "3EX");
  CHECK(scheme_name(mixed(16384, {{700, text}, {700 + 4096, text}})) == "F6");
  CHECK(scheme_name(mixed(16384, {{700, text}, {5000, text}, {5000 + 4095, text}})) == "3EX");
}

// `code` with an absolute address.
void put_access(Rom& rom, std::size_t at, unsigned opcode, unsigned address) {
  const unsigned code[] = {opcode, address & 0xFF, address >> 8};
  std::copy(std::begin(code), std::end(code), rom.begin() + static_cast<long>(at));
}

// Each of `count` hot spots is accessed once, by code of the first bank that runs in RAM.
Rom with_each(std::size_t size, unsigned opcode, unsigned first, unsigned step, unsigned count) {
  Rom rom = mixed(size);
  for (unsigned i = 0; i < count; ++i) put_access(rom, 300 + 6 * i, opcode, first + i * step);
  return rom;
}

// The first `banks` banks select each other at one offset.
Rom with_alike(std::size_t size, unsigned opcode, unsigned address, unsigned step, unsigned banks) {
  Rom rom = mixed(size);
  for (unsigned bank = 0; bank < banks; ++bank)
    put_access(rom, 4096UL * bank + 300, opcode, address + bank * step);
  return rom;
}

TEST_CASE("EF, DF and BF are found by code that accesses their hot spots") {
  struct {
    std::size_t size;
    unsigned first, count;
    const char *scheme, *otherwise;
  } const kSchemes[] = {
      {65536, 0xFE0, 16, "EF", "MB"}, {131072, 0xFC0, 32, "DF", "MC"}, {262144, 0xF80, 64, "BF", ""}};
  for (const auto& [size, first, count, scheme, otherwise] : kSchemes)
    for (const unsigned high : {0x1000U, 0xF000U})
      for (const unsigned opcode : {0xADU, 0x8DU, 0x2CU, 0x0CU}) {
        INFO(scheme << std::hex << ' ' << high << ' ' << opcode);
        CHECK(scheme_name(with_each(size, opcode, high + first, 1, count)) == scheme);
        CHECK(scheme_name(with_alike(size, opcode, high + first, 1, 4)) == scheme);
        CHECK(scheme_name(with_alike(size, opcode, high + first, 0, 4)) == scheme);
        CHECK(scheme_name(with_alike(size, 0xBD, high + first - 1, 0, 16)) == scheme);
        CHECK(scheme_name(with_each(size, opcode, high + first, 1, count / 4)) == otherwise);
        CHECK(scheme_name(with_alike(size, opcode, high + first, 1, 3)) == otherwise);
      }
  CHECK(scheme_name(with_alike(65536, 0xAD, 0xFFF0, 0, 16)) == "MB");
}

TEST_CASE("Schemes of two banks are found by code that accesses both hot spots again, or one at one offset") {
  struct {
    unsigned bank0, bank1;
    const char* scheme;
  } const kSchemes[] = {{0x0220, 0x0240, "UA"},   {0x02A0, 0x02C0, "UA clone"}, {0x0FA0, 0x0FC0, "0FA0"},
                        {0x0FB0, 0x0FD0, "0FA0"}, {0x06A0, 0x06C0, "0FA0"},     {0x0800, 0x0840, "0840"}};
  for (const auto& [bank0, bank1, scheme] : kSchemes)
    for (const unsigned opcode : {0xADU, 0x8DU, 0x2CU, 0x0CU}) {
      INFO(scheme << std::hex << ' ' << bank0 << ' ' << opcode);
      Rom both = with_each(8192, opcode, bank0, bank1 - bank0, 2);
      const bool has_signature = opcode == 0x8D && bank1 == 0x0240;  // of the reference
      CHECK(scheme_name(both) == (has_signature ? "UA" : "F8"));
      put_access(both, 5000, opcode, bank1);
      CHECK(scheme_name(both) == scheme);
      CHECK(scheme_name(with_alike(8192, opcode, bank0, bank1 - bank0, 2)) == scheme);
      CHECK(scheme_name(with_alike(8192, opcode, bank1, 0, 2)) == scheme);
      CHECK(scheme_name(with_each(8192, opcode, bank0, 0, 4)) == "F8");
    }
  CHECK(scheme_name(with_alike(8192, 0xBD, 0x021F, 0, 2)) == "UA");
  Rom doubled = with_each(4096, 0xAD, 0x0220, 0x20, 2);
  doubled.insert(doubled.end(), doubled.begin(), doubled.end());
  CHECK(scheme_name(doubled) == "4K");
}

TEST_CASE("Schemes with many hot spots are found by code that accesses most of them") {
  check({{"03E0", with_each(8192, 0xAD, 0x03E0, 1, 5), "03E0"},
         {"03E0, few", with_each(8192, 0xAD, 0x03E0, 1, 4), "F8"},
         {"E0 by NOP", with_each(8192, 0x0C, 0x1FE0, 1, 8), "E0"},
         {"E0 by LDA", with_each(8192, 0xAD, 0xFFE0, 1, 8), "E0"},
         {"E0, few", with_each(8192, 0x0C, 0x1FE0, 1, 7), "F8"},
         {"E7", with_each(16384, 0xAD, 0xFFE0, 1, 7), "E7"},
         {"JANE", with_alike(16384, 0xAD, 0xFFF1, 0, 3), "JANE"},
         {"JANE, few", with_alike(16384, 0xAD, 0xFFF1, 0, 2), "F6"},
         {"JANE, once", with_each(16384, 0xAD, 0xFFF0, 1, 2), "F6"},
         {"E7, few", with_each(16384, 0xAD, 0xFFE0, 1, 6), "F6"},
         {"SB, 128K", with_each(131072, 0xAD, 0x0800, 1, 32), "SB"},
         {"SB, 256K", with_each(262144, 0xAD, 0x0800, 1, 64), "SB"},
         {"SB by its index", with_alike(262144, 0xBD, 0x0800, 0, 64), "SB"}});
}

TEST_CASE("As many different hot spots, and as many banks, as the table says are enough") {
  struct {
    std::size_t size;
    unsigned first, step, spots;
    const char *scheme, *otherwise;
  } const kSpots[] = {
      {8192, 0x1FE0, 1, 8, "E0", "F8"},    {8192, 0x03B0, 1, 5, "03E0", "F8"},
      {16384, 0x1FE0, 1, 7, "E7", "F6"},   {65536, 0x1FE0, 1, 16, "EF", "MB"},
      {65536, 0x080D, 16, 6, "X07", "MB"}, {131072, 0x0800, 1, 10, "SB", "MC"},
      {262144, 0x0800, 1, 16, "SB", ""},   {131072, 0x1FC0, 1, 28, "DF", "MC"},
      {262144, 0x1F80, 1, 56, "BF", ""},
  };
  for (const auto& [size, first, step, spots, scheme, otherwise] : kSpots) {
    INFO(scheme << " of " << size << " bytes");
    CHECK(scheme_name(with_each(size, 0xAD, first, step, spots)) == scheme);
    CHECK(scheme_name(with_each(size, 0xAD, first, step, spots - 1)) == otherwise);
  }
  for (const unsigned opcode : {0xBDU, 0xB9U, 0x9DU, 0x99U}) {
    INFO(opcode);
    for (const unsigned address : {0x0800U, 0x07FFU}) {
      CHECK(scheme_name(with_alike(131072, opcode, address, 0, 4)) == "SB");
      CHECK(scheme_name(with_alike(131072, opcode, address, 0, 3)) == "MC");
    }
    CHECK(scheme_name(with_alike(131072, opcode, 0x0801, 0, 32)) == "MC");
    CHECK(scheme_name(with_alike(131072, opcode, 0x07FE, 0, 32)) == "MC");
  }
  CHECK(scheme_name(with_alike(65536, 0xAD, 0x080D, 16, 3)) == "MB");
  CHECK(scheme_name(with_alike(8192, 0xAD, 0x0220, 0, 1)) == "F8");
}

TEST_CASE("FA2 shows by its size, FC and WD by their code") {
  check(
      {{"24K", mixed(24576), "FA2"},
       {"28K", mixed(28672), "FA2"},
       {"29K", mixed(29696), "FA2"},
       {"FC, 1", mixed(16384, {{700, {0x8D, 0xF8, 0x1F, 0x4A, 0x4A, 0x8D}}}), "FC"},
       {"FC, 2", mixed(32768, {{700, {0x8D, 0xF8, 0xFF, 0x8D, 0xFC, 0xFF}}}), "FC"},
       {"FC, 3", mixed(8192, {{700, {0x8C, 0xF9, 0xFF, 0xAD, 0xFC, 0xFF}}}), "FC"},
       {"WD", mixed(8192, {{700, {0xA5, 0x39, 0x4C}}, {800, {0xA5, 0x3A, 0x4C}}, {900, {0xA5, 0x30, 0x4C}}}),
        "WD"},
       {"WD, twice", mixed(8192, {{700, {0xA5, 0x39, 0x4C}}, {800, {0xA5, 0x3A, 0x4C}}}), "F8"}});
}

TEST_CASE("EF, DF and BF have RAM where each bank leaves room for its ports") {
  for (const auto& [size, hot_spot, scheme] :
       {std::tuple<std::size_t, unsigned, const char*>{65536, 0x1FE0, "EFSC"},
        {131072, 0x1FC0, "DFSC"},
        {262144, 0x1F80, "BFSC"}}) {
    Rom rom = with_ram_ports(size);
    for (std::size_t bank = 0; bank < size; bank += 4096) put_access(rom, bank + 300, 0xAD, hot_spot);
    CHECK(scheme_name(rom) == scheme);
  }
}

TEST_CASE("X07 is found by code that accesses its hot spots") {
  for (const Rom& rom : {with_each(65536, 0xAD, 0x080D, 16, 16), with_alike(65536, 0x0C, 0x080D, 16, 4)})
    CHECK(scheme_name(rom) == "X07");
  CHECK(scheme_name(with_each(65536, 0xAD, 0x080D, 16, 3)) == "MB");
}

unsigned below(unsigned limit, std::mt19937& random) { return static_cast<unsigned>(random() % limit); }

// Addresses as often as in the random programs that the reference is compared with: address() of
// tests/conformance/programs.py.
unsigned random_address(std::mt19937& random) {
  struct Range {
    unsigned weight, first, size;
  };
  constexpr Range kRanges[] = {{60, 0x1000, 0x1000}, {15, 0x1FE0, 0x20}, {15, 0x1000, 0x100},
                               {40, 0x0280, 0x20},   {20, 0x0180, 0x80}, {17, 0x0000, 0x40},
                               {17, 0x0040, 0x40},   {16, 0x0140, 0x40}};
  const Range* range = kRanges;
  for (unsigned weight = below(200, random); weight >= range->weight; ++range) weight -= range->weight;
  return range->first | below(range->size, random) | below(8, random) << 13;
}

// Random bytes, and about as many accesses as a random program of the size has.
Rom random_accesses(std::size_t size, std::mt19937& random) {
  Rom rom(size);
  for (std::uint8_t& byte : rom) byte = static_cast<std::uint8_t>(random());
  constexpr unsigned kOpcodes[] = {0xAD, 0x8D, 0x2C, 0x0C, 0xBD, 0x9D};
  for (std::size_t i = 0; i < size / 50; ++i)
    put_access(rom, random() % (size - 2), kOpcodes[random() % 6], random_address(random));
  return rom;
}

TEST_CASE("Random bytes and random accesses have the scheme that the reference gives them") {
  std::mt19937 random(42);
  const std::map<std::size_t, std::set<std::string_view>> may_be = {{8192, {"F8", "3F", "3E", "UA", "E0"}},
                                                                    {16384, {"F6", "3F", "3E"}},
                                                                    {65536, {"MB", "3F", "3E"}},
                                                                    {131072, {"MC", "3F", "3E"}}};
  for (int i = 0; i < 300; ++i)
    for (const auto& [size, names] : may_be) {
      const std::string_view name = scheme_name(random_accesses(size, random));
      INFO(i << ": " << size << " bytes, " << name);
      CHECK(names.contains(name));
    }
}

TEST_CASE("A scheme that is asked for goes before the detected one, if the image has a size that fits") {
  for (const std::string_view name : scheme_names()) {
    INFO(name);
    const unsigned least = scheme_named(name).least_image, most = scheme_named(name).most_image;
    const auto refused_size = [&](unsigned bound, unsigned size) {
      CHECK_THROWS_WITH(scheme_of(mixed(size), name),
                        Catch::Contains(std::string(name)) && Catch::Contains(std::to_string(bound)));
    };
    CHECK(scheme_of(mixed(most == 0 ? 262144 : most), name).name == name);
    CHECK(scheme_of(mixed(least), name).name == name);
    refused_size(least, least - 1);
    if (most != 0) refused_size(most, most + 1);
  }
}

}  // namespace
}  // namespace racebeam::test
