#include "emulator/cartridge/detection/marks.hpp"

#include <algorithm>
#include <array>
#include <bitset>
#include <cstddef>

namespace racebeam {
namespace {

// Tools that make images of these schemes write a text into them. FC's are not text, but code that its
// programs have.
struct Text {
  std::string_view text;
  int hits;                 // short texts must be there more than once, close together
  std::size_t least, most;  // bytes of an image of the scheme
  std::string_view scheme;
};

constexpr std::size_t kAnySize = ~std::size_t{0};
constexpr std::string_view kCdf0("CDF\0", 4);  // the version behind the text is a byte
constexpr Text kTexts[] = {
    {"DPC+", 1, 8192, kAnySize, "DPC+"},
    {"PLUSCDFJ", 1, 8192, kAnySize, "CDFJ+"},
    {"CDFJ", 2, 8192, kAnySize, "CDFJ"},
    {kCdf0, 2, 8192, kAnySize, "CDF0"},
    {"CDF", 2, 8192, kAnySize, "CDF"},
    {"BUS", 2, 32768, kAnySize, "BUS"},
    {"EFEF", 1, 65536, 65536, "EF"},
    {"EFSC", 1, 65536, 65536, "EFSC"},
    {"DFDF", 1, 131072, 131072, "DF"},
    {"DFSC", 1, 131072, 131072, "DFSC"},
    {"BFBF", 1, 262144, 262144, "BF"},
    {"BFSC", 1, 262144, 262144, "BFSC"},
    {"TJ3E", 1, 2048, kAnySize, "3E+"},
    {"3EX", 2, 8192, kAnySize, "3EX"},
    {"\x8D\xF8\x1F\x4A\x4A\x8D", 1, 8192, kAnySize, "FC"},
    {"\x8D\xF8\xFF\x8D\xFC\xFF", 1, 8192, kAnySize, "FC"},
    {"\x8C\xF9\xFF\xAD\xFC\xFF", 1, 8192, kAnySize, "FC"},
    {"MDMC", 1, 8192, kAnySize, "MDM"},
    {"LENIN", 1, 32768, kAnySize, "CTY"},
};

// Other images have only the code that accesses the hot spots: addresses from `first` on, `step` apart, or
// the same with `mirror` added. Random bytes and random programs contain many accesses, too. They hardly ever
// access `least` of the hot spots, by kFewest accesses or more, or have an access at one offset in several
// banks. A real program has that: after the access, it goes on at the next offset of the other bank.
struct HotSpots {
  std::size_t size;  // of the image
  unsigned first, step, count, mirror, least;
  int alike;  // banks with an access at one offset
  std::string_view scheme;
};

constexpr int kNever = 100, kFewest = 3;
constexpr HotSpots kHotSpots[] = {
    {8192, 0x1FE0, 1, 8, 0xE000, 8, kNever, "E0"},    {8192, 0x0220, 0x20, 2, 0, 2, 2, "UA"},
    {8192, 0x02A0, 0x20, 2, 0, 2, 2, "UA clone"},     {8192, 0x0FA0, 0x20, 2, 0, 2, 2, "0FA0"},
    {8192, 0x0FB0, 0x20, 2, 0, 2, 2, "0FA0"},         {8192, 0x06A0, 0x20, 2, 0, 2, 2, "0FA0"},
    {8192, 0x0800, 0x40, 2, 0, 2, 2, "0840"},         {8192, 0x03B0, 1, 56, 0, 5, kNever, "03E0"},
    {16384, 0x1FF0, 1, 2, 0xE000, kNever, 3, "JANE"}, {16384, 0x1FE0, 1, 7, 0xE000, 7, kNever, "E7"},
    {65536, 0x1FE0, 1, 16, 0xE000, 16, 4, "EF"},      {65536, 0x080D, 16, 16, 0, 6, 4, "X07"},
    {131072, 0x0800, 1, 32, 0, 10, 4, "SB"},          {262144, 0x0800, 1, 64, 0, 16, 4, "SB"},
    {131072, 0x1FC0, 1, 32, 0xE000, 28, 4, "DF"},     {262144, 0x1F80, 1, 64, 0xE000, 56, 4, "BF"},
};
constexpr std::string_view kElf =
    "\x7F"
    "ELF";                               // how an object file begins
constexpr std::size_t kWdswSize = 8195;  // no other image has this size
constexpr std::size_t kMin4a50 = 65536;  // whose vector of NMI, which the 6507 does not have, is $4A50
constexpr std::size_t kMaxHotSpots = 64, kBank = 4096;

bool has(std::string_view image, const Text& mark) {
  if (image.size() < mark.least || image.size() > mark.most) return false;
  int hits = 0;
  std::size_t last = 0;
  for (auto at = image.find(mark.text); at != image.npos; at = image.find(mark.text, at + 1)) {
    hits = at - last < kBank ? hits + 1 : 1;
    if (hits == mark.hits) return true;
    last = at;
  }
  return false;
}

// LDA, STA, BIT and NOP of an absolute address: the instructions that select a bank and change little else.
bool is_access(std::uint8_t opcode) {
  constexpr std::uint8_t kOpcodes[] = {0xAD, 0x8D, 0x2C, 0x0C};
  return std::ranges::find(kOpcodes, opcode) != std::end(kOpcodes);
}

// LDA and STA with an index that is the bank's number, counted from 0 or 1.
bool is_indexed(std::uint8_t opcode) {
  constexpr std::uint8_t kOpcodes[] = {0xBD, 0xB9, 0x9D, 0x99};
  return std::ranges::find(kOpcodes, opcode) != std::end(kOpcodes);
}

bool accesses(const Rom& rom, const HotSpots& spots) {
  if (rom.size() != spots.size) return false;
  std::bitset<kMaxHotSpots> found;
  std::array<std::uint8_t, kBank> alike{};
  int hits = 0;
  for (std::size_t i = 0; i + 2 < rom.size(); ++i) {
    unsigned address = rom[i + 1] | rom[i + 2] * 256U;
    if (address + 1 >= spots.mirror + spots.first) address -= spots.mirror;
    const unsigned distance = address - spots.first, number = distance / spots.step;
    const bool direct = is_access(rom[i]) && distance % spots.step == 0 && number < spots.count;
    if (direct) found.set(number), ++hits;
    if (!direct && !(is_indexed(rom[i]) && distance + 1 <= 1)) continue;
    if (++alike[i % kBank] == spots.alike) return true;
  }
  return hits >= kFewest && found.count() >= spots.least;
}

// WD selects at $30-$3F: LDA, and a jump.
bool is_wd(const Rom& rom) {
  if (rom.size() != 8192) return false;
  int hits = 0;
  for (std::size_t i = 0; i + 2 < rom.size(); ++i)
    hits += rom[i] == 0xA5 && (rom[i + 1] & 0xF0) == 0x30 && rom[i + 2] == 0x4C;
  return hits >= kFewest;
}

}  // namespace

std::string_view scheme_by_text(const Rom& rom) {
  const std::string_view image(reinterpret_cast<const char*>(rom.data()), rom.size());
  if (image.starts_with(kElf)) return "ELF";  // before the texts that the program has
  if (image.size() == kWdswSize) return "WDSW";
  if (image.size() >= kMin4a50 && image.substr(image.size() - 6, 2) == "\x50\x4A") return "4A50";
  const auto text = std::ranges::find_if(kTexts, [&](const Text& one) { return has(image, one); });
  return text != std::end(kTexts) ? text->scheme : std::string_view();
}

// BX of R0, R1, R3 or LR ends a function. 32K of other images have one or two at even offsets.
bool has_arm_code(const Rom& rom) {
  constexpr std::uint8_t kReturn = 0x47, kRegisters[] = {0x00, 0x08, 0x18, 0x70};
  constexpr std::size_t kMinImage = 24576, kBlock = 32768;
  constexpr int kFewestReturns = 8;
  if (rom.size() < kMinImage) return false;
  int returns = 0;
  for (std::size_t i = 0; i + 1 < rom.size(); i += 2) {
    if (i % kBlock == 0) returns = 0;
    if (rom[i + 1] != kReturn || std::ranges::find(kRegisters, rom[i]) == std::end(kRegisters)) continue;
    if (++returns == kFewestReturns) return true;
  }
  return false;
}

std::string_view scheme_by_accesses(const Rom& rom) {
  if (is_wd(rom)) return "WD";
  const auto spots = std::ranges::find_if(kHotSpots, [&](const HotSpots& one) { return accesses(rom, one); });
  return spots != std::end(kHotSpots) ? spots->scheme : std::string_view();
}

}  // namespace racebeam
