#include "emulator/cartridge/mappers/unsupported.hpp"

#include <algorithm>
#include <bitset>
#include <cstddef>

namespace racebeam {
namespace {

// Tools that make images of these schemes write a text into them.
struct Text {
  std::string_view text;
  int hits;           // short texts must be there more than once
  std::size_t least;  // bytes of the smallest image of the scheme
  std::string_view scheme;
};

constexpr Text kTexts[] = {
    {"DPC+", 1, 8192, "DPC+"},  {"PLUSCDFJ", 1, 8192, "CDFJ+"}, {"CDF", 2, 8192, "CDF"},
    {"BUS", 2, 32768, "BUS"},   {"EFEF", 1, 65536, "EF"},       {"EFSC", 1, 65536, "EFSC"},
    {"DFDF", 1, 65536, "DF"},   {"DFSC", 1, 65536, "DFSC"},     {"BFBF", 1, 65536, "BF"},
    {"BFSC", 1, 65536, "BFSC"}, {"TJ3E", 1, 2048, "3E+"},       {"3EX", 2, 8192, "3EX"},
    {"MDMC", 1, 8192, "MDM"},   {"LENIN", 1, 32768, "CTY"},
};

// Other images have only the code that accesses the hot spots: addresses from `first` on, `step` apart, or
// the same with `mirror` added.
struct HotSpots {
  std::size_t size;  // of the image
  unsigned first, step, count, mirror;
  std::string_view scheme;
};

constexpr HotSpots kHotSpots[] = {
    {65536, 0x1FE0, 1, 16, 0xE000, "EF"},
    {65536, 0x080D, 16, 16, 0, "X07"},
    {131072, 0x1FC0, 1, 32, 0xE000, "DF"},
};

constexpr std::string_view kOthers[] = {
    "0840",  "4A50",   "0FA0", "03E0", "4KSC", "8IN1", "16IN1", "2IN1", "32IN1",
    "64IN1", "128IN1", "CDFJ", "CM",   "ELF",  "FA2",  "FC",    "GL",   "JANE",
    "SB",    "TVBOY",  "UASW", "WD",   "WDSW", "WF8",  "DEVC",  "EFF",
};

bool has(std::string_view image, const Text& wanted) {
  if (image.size() < wanted.least) return false;
  int hits = 0;
  for (auto at = image.find(wanted.text); at != image.npos && hits < wanted.hits; ++hits)
    at = image.find(wanted.text, at + wanted.text.size());
  return hits == wanted.hits;
}

// LDA, STA, BIT and NOP of an absolute address: the instructions that select a bank and change little else.
bool is_access(std::uint8_t opcode) {
  constexpr std::uint8_t kOpcodes[] = {0xAD, 0x8D, 0x2C, 0x0C};
  return std::ranges::find(kOpcodes, opcode) != std::end(kOpcodes);
}

// A quarter of the hot spots must be there: three bytes that look like one access occur by chance.
bool accesses(const std::vector<std::uint8_t>& rom, const HotSpots& spots) {
  if (rom.size() != spots.size) return false;
  std::bitset<32> found;
  for (std::size_t i = 0; i + 2 < rom.size(); ++i) {
    if (!is_access(rom[i])) continue;
    unsigned address = rom[i + 1] | rom[i + 2] * 256U;
    if (address >= spots.mirror + spots.first) address -= spots.mirror;
    if (address < spots.first || (address - spots.first) % spots.step != 0) continue;
    const unsigned number = (address - spots.first) / spots.step;
    if (number < spots.count) found.set(number);
  }
  return found.count() >= spots.count / 4;
}

}  // namespace

std::string_view unsupported_scheme(const std::vector<std::uint8_t>& rom) {
  const std::string_view image(reinterpret_cast<const char*>(rom.data()), rom.size());
  for (const Text& text : kTexts)
    if (has(image, text)) return text.scheme;
  for (const HotSpots& spots : kHotSpots)
    if (accesses(rom, spots)) return spots.scheme;
  return {};
}

bool is_unsupported(std::string_view name) {
  return std::ranges::find(kOthers, name) != std::end(kOthers) ||
         std::ranges::find(kTexts, name, &Text::scheme) != std::end(kTexts) ||
         std::ranges::find(kHotSpots, name, &HotSpots::scheme) != std::end(kHotSpots);
}

}  // namespace racebeam
