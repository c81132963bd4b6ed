// The table of schemes, and the detection of an image's scheme (docs/spec/cartridges.md, 2).
#include <algorithm>
#include <array>
#include <initializer_list>
#include <span>
#include <string>
#include <utility>

#include "emulator/cartridge/cartridge.hpp"
#include "emulator/cartridge/mappers/activision.hpp"
#include "emulator/cartridge/mappers/atari.hpp"
#include "emulator/cartridge/mappers/commavid.hpp"
#include "emulator/cartridge/mappers/dpc.hpp"
#include "emulator/cartridge/mappers/dynacom.hpp"
#include "emulator/cartridge/mappers/megacart.hpp"
#include "emulator/cartridge/mappers/mnetwork.hpp"
#include "emulator/cartridge/mappers/parker.hpp"
#include "emulator/cartridge/mappers/starpath.hpp"
#include "emulator/cartridge/mappers/tigervision.hpp"
#include "emulator/cartridge/mappers/ua.hpp"
#include "emulator/cartridge/mappers/unsupported.hpp"
#include "system/invalid_input.hpp"

namespace racebeam {
namespace {

std::uint8_t no_hidden_page(CartridgeSlot&, std::uint16_t, std::int32_t) { return 0; }

bool no_banks(const CartridgeSlot&, const CartridgeState& state) { return banks_unused(state, 0); }

// F4SC's hot spots react to reads only.
Delivery write_f4sc(CartridgeSlot& slot, std::uint16_t address, std::uint8_t value) {
  return atari::write_ram(slot, address, value);
}

// clang-format off
constexpr Delivery (*kIgnore)(CartridgeSlot&, std::uint16_t, std::uint8_t) = atari::ignore_write;

//                               reset                   map                  read            write                  admits
constexpr MapperOps kPlain    = {atari::reset,           atari::map_plain,    no_hidden_page, kIgnore,               atari::admits};
constexpr MapperOps kAtari    = {atari::reset,           atari::map,          atari::read,    atari::write,          atari::admits};
constexpr MapperOps kF4sc     = {atari::reset,           atari::map,          atari::read,    write_f4sc,            atari::admits};
constexpr MapperOps kE0       = {parker::reset,          parker::map,         parker::read,   parker::write,         parker::admits};
constexpr MapperOps kE7       = {mnetwork::reset,        mnetwork::map,       mnetwork::read, mnetwork::write,       mnetwork::admits};
constexpr MapperOps kFe       = {activision::reset,      activision::map,     no_hidden_page, kIgnore,               no_banks};
constexpr MapperOps kDpc      = {dpc::reset,             dpc::map,            dpc::read,      dpc::write,            dpc::admits, dpc::power_on, dpc::port_reader};
constexpr MapperOps k3f       = {tigervision::reset,     tigervision::map,    no_hidden_page, tigervision::write,    tigervision::admits};
constexpr MapperOps k3e       = {tigervision::reset_3e,  tigervision::map_3e, no_hidden_page, tigervision::write_3e, tigervision::admits_3e};
constexpr MapperOps kUa       = {atari::reset,           ua::map,             ua::read,       ua::write,             atari::admits};
constexpr MapperOps kCv       = {commavid::reset_empty,  commavid::map,       no_hidden_page, commavid::write,       no_banks};
constexpr MapperOps kCvFilled = {commavid::reset_filled, commavid::map,       no_hidden_page, commavid::write,       no_banks};
constexpr MapperOps kAr       = {starpath::reset,        starpath::map,       starpath::read, starpath::write,       starpath::admits};
constexpr MapperOps kMb       = {atari::reset,           atari::map,          dynacom::read,  dynacom::write,        atari::admits};
constexpr MapperOps kMc       = {megacart::reset,        megacart::map,       megacart::read, megacart::write,       megacart::admits};

constexpr unsigned kChip = sizeof(dpc::Chip);

constexpr Scheme kSchemes[] = {
    // ops      name          image  hotspot banks init  ram  random  TIA
    {kPlain,    "2K",           2048, 0,        1, 0,     0, false, false},
    {kPlain,    "4K",           4096, 0,        1, 0,     0, false, false},
    {kAtari,    "F8",           8192, 0xFF8,    2, 1,     0, false, false},
    {kAtari,    "F8 swapped",   8192, 0xFF8,    2, 0,     0, false, false},
    {kAtari,    "F8SC",         8192, 0xFF8,    2, 1,   128, true,  false},
    {kAtari,    "F6",          16384, 0xFF6,    4, 0,     0, false, false},
    {kAtari,    "F6SC",        16384, 0xFF6,    4, 0,   128, true,  false},
    {kAtari,    "F4",          32768, 0xFF4,    8, 0,     0, false, false},
    {kF4sc,     "F4SC",        32768, 0xFF4,    8, 0,   128, true,  false},
    {kAtari,    "FASC",        12288, 0xFF8,    3, 2,   256, true,  false},
    {kE0,       "E0",           8192, 0,        0, 0,     0, false, false},
    {kE7,       "E7",          16384, 0,        0, 0,  2048, true,  false},
    {kFe,       "FE",           8192, 0,        0, 0,     0, false, false},
    {kDpc,      "DPC",         10240, 0xFF8,    2, 1, kChip, false, false},
    {k3f,       "3F",           2048, 0,        0, 0,     0, false, true},
    {k3e,       "3E",           2048, 0,        0, 0, 32768, true,  true},
    {kUa,       "UA",           8192, 0,        2, 0,     0, false, true},
    {kCv,       "CV",           2048, 0,        0, 0,  1024, true,  false},
    {kCvFilled, "CV 4K",        4096, 0,        0, 0,  1024, false, false},
    {kAr,       "AR",           8448, 0,        0, 0,  6144, true,  false},
    {kMb,       "MB",          65536, 0xFF0,   16, 1,     0, false, false},
    {kMc,       "MC",         131072, 0,        0, 0, 32768, true,  true},
};
// clang-format on

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

// On-board RAM hides the first 256 bytes of each bank. Their content is therefore the same in each bank.
bool is_sc(const Rom& rom) {
  const std::span<const std::uint8_t> bytes(rom);
  for (std::size_t bank = 0; bank < rom.size(); bank += 4096)
    if (!all_equal(bytes.subspan(bank, 256))) return false;
  return true;
}

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

std::string_view name_8k(const Rom& rom) {
  if (is_sc(rom)) return "F8SC";
  if (halves_equal(rom)) return "4K";
  if (is_e0(rom)) return "E0";
  if (is_3e(rom)) return "3E";
  if (is_3f(rom)) return "3F";
  if (is_ua(rom)) return "UA";
  return is_fe(rom) ? "FE" : "F8";
}

std::string_view name_16k(const Rom& rom) {
  if (is_sc(rom)) return "F6SC";
  if (is_e7(rom)) return "E7";
  if (is_3e(rom)) return "3E";
  return is_3f(rom) ? "3F" : "F6";
}

// Two schemes can have any size. Otherwise the size decides.
std::string_view name_large(const Rom& rom, std::string_view otherwise) {
  if (is_3e(rom)) return "3E";
  return is_3f(rom) ? "3F" : otherwise;
}

[[noreturn]] void refuse_scheme(std::string sentence) {
  std::string_view separator = "; implemented are ";
  for (const Scheme& scheme : kSchemes) sentence.append(std::exchange(separator, ", ")).append(scheme.name);
  throw InvalidInput(sentence);
}

}  // namespace

std::string_view scheme_name(const Rom& rom) {
  if (!rom.empty() && rom.size() % 8448 == 0) return "AR";
  switch (rom.size()) {
    case 2048: return is_cv(rom) ? "CV" : "2K";
    case 4096: return is_cv(rom) ? "CV 4K" : halves_equal(rom) ? "2K" : "4K";
    case 8192: return name_8k(rom);
    case 10240:
    case 10495:
    case 10496: return "DPC";
    case 12288: return "FASC";
    case 16384: return name_16k(rom);
    case 32768: return is_sc(rom) ? "F4SC" : name_large(rom, "F4");
    case 65536: return name_large(rom, "MB");
    case 131072: return name_large(rom, "MC");
    default: return rom.size() < tigervision::kBankSize ? "" : name_large(rom, "");
  }
}

const Scheme& scheme_named(std::string_view name) {
  const auto scheme = std::ranges::find(kSchemes, name, &Scheme::name);
  if (scheme != std::end(kSchemes)) return *scheme;
  const std::string what = "the cartridge scheme " + std::string(name);
  refuse_scheme(is_unsupported(name) ? what + " is not implemented" : what + " is not known");
}

const Scheme& scheme_of(const Rom& rom, std::string_view asked_for) {
  const std::string size = std::to_string(rom.size()) + " bytes";
  if (asked_for.empty()) {
    if (const auto other = unsupported_scheme(rom); !other.empty())
      refuse_scheme("the image is for the cartridge scheme " + std::string(other) +
                    ", which is not implemented");
    asked_for = scheme_name(rom);
  }
  if (asked_for.empty()) {
    throw InvalidInput("no cartridge scheme fits an image of " + size +
                       "; usual sizes are 2048, 4096, 8192, 16384 and 32768 bytes");
  }
  const Scheme& scheme = scheme_named(asked_for);
  if (rom.size() < scheme.image) {
    throw InvalidInput("the cartridge scheme " + std::string(scheme.name) + " needs an image of at least " +
                       std::to_string(scheme.image) + " bytes; this one has " + size);
  }
  return scheme;
}

std::span<const std::string_view> scheme_names() {
  static constexpr auto kNames = [] {
    std::array<std::string_view, std::size(kSchemes)> names;
    std::ranges::transform(kSchemes, names.begin(), &Scheme::name);
    return names;
  }();
  return kNames;
}

}  // namespace racebeam
