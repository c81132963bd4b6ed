// The detection of an image's scheme (docs/spec/cartridges.md, 2).
#include <algorithm>
#include <initializer_list>
#include <span>

#include "emulator/cartridge/cartridge.hpp"
#include "emulator/cartridge/detection/marks.hpp"

namespace racebeam {
namespace {

using Signature = std::initializer_list<std::uint8_t>;

// Searches as the reference does: the last possible position is not examined, and after a hit one more byte
// is skipped.
bool contains(const Rom& rom, Signature signature, int hits = 1) {
  const std::size_t length = signature.size();
  for (std::size_t i = 0; i + length + 1 <= rom.size(); ++i) {
    if (!std::equal(signature.begin(), signature.end(), rom.begin() + static_cast<std::ptrdiff_t>(i)))
      continue;
    if (--hits == 0) return true;
    i += length;
  }
  return false;
}

bool contains_any(const Rom& rom, std::initializer_list<Signature> signatures) {
  return std::any_of(signatures.begin(), signatures.end(),
                     [&](const Signature& s) { return contains(rom, s); });
}

bool all_equal(std::span<const std::uint8_t> bytes) {
  return std::all_of(bytes.begin(), bytes.end(), [&](std::uint8_t b) { return b == bytes.front(); });
}

bool halves_equal(const Rom& rom) {
  const auto middle = rom.begin() + static_cast<std::ptrdiff_t>(rom.size() / 2);
  return std::equal(rom.begin(), middle, middle);
}

using Bytes = std::span<const std::uint8_t>;

bool has_period(Bytes bytes, std::size_t period) {
  return std::ranges::equal(bytes.first(bytes.size() - period), bytes.subspan(period));
}

// Whether the first 256 bytes of each bank repeat after `period` bytes.
bool banks_begin_with_period(const Rom& rom, std::size_t period) {
  constexpr std::size_t kBank = 4096, kPorts = 256;
  for (std::size_t bank = 0; bank < rom.size(); bank += kBank)
    if (!has_period(Bytes(rom).subspan(bank, kPorts), period)) return false;
  return true;
}

// On-board RAM hides the first 256 bytes of each bank. Tools fill them with one byte.
bool is_sc(const Rom& rom) { return banks_begin_with_period(rom, 1); }

// A dump of a cartridge has the contents of the RAM there, once for each port. A shorter period is a pattern
// of the program's.
bool has_ports(const Rom& rom) {
  return is_sc(rom) || (banks_begin_with_period(rom, 128) && !banks_begin_with_period(rom, 64));
}

// In front of the reset vector.
bool is_marked_sc(const Rom& rom) { return rom[rom.size() - 6] == 'S' && rom[rom.size() - 5] == 'C'; }

bool is_cv(const Rom& rom) { return contains_any(rom, {{0x9D, 0xFF, 0xF3}, {0x99, 0x00, 0xF4}}); }
bool is_3e(const Rom& rom) { return contains(rom, {0x85, 0x3E, 0xA9, 0x00}); }
bool is_3f(const Rom& rom) { return contains(rom, {0x85, 0x3F}, 2); }
bool is_ua(const Rom& rom) { return contains(rom, {0x8D, 0x40, 0x02}); }

bool is_e0(const Rom& rom) {
  return contains_any(rom, {{0x8D, 0xE0, 0x1F},
                            {0x8D, 0xE0, 0x5F},
                            {0x8D, 0xE9, 0xFF},
                            {0xAD, 0xE9, 0xFF},
                            {0xAD, 0xED, 0xFF},
                            {0xAD, 0xF3, 0xBF}});
}

bool is_fe(const Rom& rom) {
  return contains_any(rom, {{0x20, 0x00, 0xD0, 0xC6, 0xC5},
                            {0x20, 0xC3, 0xF8, 0xA5, 0x82},
                            {0xD0, 0xFB, 0x20, 0x73, 0xFE},
                            {0x20, 0x00, 0xF0, 0x84, 0xD6}});
}

bool is_e7(const Rom& rom) {
  const auto differs = [&](std::size_t from) {
    return std::any_of(rom.begin() + static_cast<std::ptrdiff_t>(from),
                       rom.begin() + static_cast<std::ptrdiff_t>(from + 32),
                       [&](std::uint8_t b) { return b != rom[0x3800]; });
  };
  return all_equal(std::span(rom).subspan(0x3800, 0x200)) && (differs(0x37E0) || differs(0x3A00));
}

// The reference has only these tests, but for has_ports() and is_marked_sc().
std::string_view name_4k(const Rom& rom) {
  if (is_cv(rom)) return "CV 4K";
  if (is_sc(rom) && is_marked_sc(rom)) return "4KSC";
  if (halves_equal(rom)) return "2K";
  return has_ports(rom) && !is_sc(rom) ? "4KSC" : "4K";
}

std::string_view name_8k(const Rom& rom) {
  if (is_sc(rom)) return "F8SC";
  if (halves_equal(rom)) return "4K";
  if (has_ports(rom)) return "F8SC";
  if (is_e0(rom)) return "E0";
  if (is_3e(rom)) return "3E";
  if (is_3f(rom)) return "3F";
  if (is_ua(rom)) return "UA";
  return is_fe(rom) ? "FE" : "F8";
}

std::string_view name_16k(const Rom& rom) {
  if (has_ports(rom)) return "F6SC";
  if (is_e7(rom)) return "E7";
  if (is_3e(rom)) return "3E";
  return is_3f(rom) ? "3F" : "F6";
}

// Two schemes can have any size. Otherwise the size decides.
std::string_view name_large(const Rom& rom, std::string_view otherwise) {
  if (is_3e(rom)) return "3E";
  return is_3f(rom) ? "3F" : otherwise;
}

// A scheme of Atari's kind that its hot spots show, with or without RAM.
std::string_view with_ports(std::string_view scheme, bool has_ports) {
  if (!has_ports) return scheme;
  if (scheme == "EF") return "EFSC";
  if (scheme == "DF") return "DFSC";
  return scheme == "BF" ? "BFSC" : scheme;
}

std::string_view scheme_by_size(const Rom& rom) {
  constexpr std::size_t kMinSize = 2048;
  if (!rom.empty() && rom.size() % 8448 == 0) return "AR";
  switch (rom.size()) {
    case 2048: return is_cv(rom) ? "CV" : "2K";
    case 4096: return name_4k(rom);
    case 8192: return name_8k(rom);
    case 10240:
    case 10495:
    case 10496: return "DPC";
    case 12288: return "FASC";
    case 16384: return name_16k(rom);
    case 32768: return has_ports(rom) ? "F4SC" : name_large(rom, "F4");
    case 24576:
    case 28672:
    case 29696: return name_large(rom, "FA2");
    case 65536: return name_large(rom, "MB");
    case 131072: return name_large(rom, "MC");
    default: return rom.size() < kMinSize ? "" : name_large(rom, "");
  }
}

// Instructions with an absolute address; of those with an index, the address is often one too low.
struct AbsoluteAccess {
  bool is_one, is_indexed;
};
AbsoluteAccess absolute_access(std::uint8_t opcode) {
  constexpr std::uint8_t kCall = 0x20;
  const unsigned column = opcode & 0x1F;
  const bool is_indexed = column == 0x19 || column >= 0x1B;
  return {opcode == kCall || is_indexed || (column >= 0x0C && column <= 0x0F), is_indexed};
}

}  // namespace

bool accesses_no_hot_spot(const Rom& rom, const Scheme& scheme) {
  constexpr unsigned kCartridge = 0x1000, kDecoded = 0x1FFF;
  if (scheme.first_hot_spot == 0 || scheme.banks < 2) return false;
  for (std::size_t i = 0; i + 2 < rom.size(); ++i) {
    const AbsoluteAccess access = absolute_access(rom[i]);
    const unsigned address = (rom[i + 1] | rom[i + 2] * 256U) & kDecoded,
                   first = kCartridge + scheme.first_hot_spot;
    const bool is_near = address + (access.is_indexed ? 1U : 0U) >= first && address < first + scheme.banks;
    if (access.is_one && is_near) return false;
  }
  return true;
}

std::string_view scheme_name(const Rom& rom) {
  if (const std::string_view text = scheme_by_text(rom); !text.empty()) return text;
  const std::string_view accessed = halves_equal(rom) ? std::string_view() : scheme_by_accesses(rom);
  return accessed.empty() ? scheme_by_size(rom) : with_ports(accessed, has_ports(rom));
}

}  // namespace racebeam
