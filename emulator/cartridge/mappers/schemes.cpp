// The table of schemes (docs/spec/cartridges.md, 5 to 11).
#include <algorithm>
#include <array>
#include <deque>
#include <span>
#include <string>
#include <utility>

#include "emulator/cartridge/cartridge.hpp"
#include "emulator/cartridge/detection/marks.hpp"
#include "emulator/cartridge/harmony/cdf.hpp"
#include "emulator/cartridge/harmony/dpcplus.hpp"
#include "emulator/cartridge/mappers/activision.hpp"
#include "emulator/cartridge/mappers/amiga.hpp"
#include "emulator/cartridge/mappers/atari.hpp"
#include "emulator/cartridge/mappers/atariage.hpp"
#include "emulator/cartridge/mappers/coleco.hpp"
#include "emulator/cartridge/mappers/commavid.hpp"
#include "emulator/cartridge/mappers/dpc.hpp"
#include "emulator/cartridge/mappers/dynacom.hpp"
#include "emulator/cartridge/mappers/jentzsch.hpp"
#include "emulator/cartridge/mappers/megacart.hpp"
#include "emulator/cartridge/mappers/mnetwork.hpp"
#include "emulator/cartridge/mappers/parker.hpp"
#include "emulator/cartridge/mappers/payson.hpp"
#include "emulator/cartridge/mappers/savecircuit.hpp"
#include "emulator/cartridge/mappers/starcastle.hpp"
#include "emulator/cartridge/mappers/starpath.hpp"
#include "emulator/cartridge/mappers/superbank.hpp"
#include "emulator/cartridge/mappers/tigervision.hpp"
#include "emulator/cartridge/mappers/ua.hpp"
#include "emulator/cartridge/mappers/wickstead.hpp"
#include "system/invalid_input.hpp"

namespace racebeam {
namespace {

std::uint8_t no_hidden_page(CartridgeSlot&, std::uint16_t, std::int32_t) { return 0; }

bool no_banks(const CartridgeSlot&, const CartridgeState& state) { return banks_unused(state, 0); }

using Watch = Scheme::Watch;

// clang-format off
constexpr Delivery (*kIgnore)(CartridgeSlot&, std::uint16_t, std::uint8_t) = atari::ignore_write;

//                               reset                   map                  read            write                  admits
constexpr MapperOps kPlain    = {atari::reset,           atari::map_plain,    no_hidden_page, kIgnore,               atari::admits};
constexpr MapperOps kAtari    = {atari::reset,           atari::map,          atari::read,    atari::write,          atari::admits};
constexpr MapperOps kPlainSc  = {atari::reset,           atari::map_plain,    no_hidden_page, atari::write_ram,      atari::admits};
constexpr MapperOps kF4sc     = {atari::reset,           atari::map,          atari::read,    atari::write_ram,      atari::admits};  // reads only select
constexpr MapperOps kE0       = {parker::reset,          parker::map,         parker::read,   parker::write,         parker::admits};
constexpr MapperOps kE7       = {mnetwork::reset,        mnetwork::map,       mnetwork::read, mnetwork::write,       mnetwork::admits};
constexpr MapperOps kFe       = {activision::reset,      activision::map,     no_hidden_page, kIgnore,               no_banks};
constexpr MapperOps kDpc      = {dpc::reset,             dpc::map,            dpc::read,      dpc::write,            dpc::admits, dpc::power_on, dpc::port_reader};
constexpr MapperOps kDpcPlus  = {dpcplus::reset,         dpcplus::map,        dpcplus::read,  dpcplus::write,        dpcplus::admits, nullptr, dpcplus::port_reader};
constexpr MapperOps kCdf      = {cdf::reset,             cdf::map,            cdf::read,      cdf::write,            cdf::admits};
constexpr MapperOps k3f       = {tigervision::reset,     tigervision::map,    tigervision::read, tigervision::write,    tigervision::admits};
constexpr MapperOps k3e       = {tigervision::reset_3e,  tigervision::map_3e, tigervision::read, tigervision::write_3e, tigervision::admits_3e};
constexpr MapperOps kJane     = {atari::reset,           atari::map,          coleco::read,   coleco::write,         atari::admits};
constexpr MapperOps kWf8      = {atari::reset,           atari::map,          coleco::read_wf8, coleco::write_wf8,   atari::admits};
constexpr MapperOps k3ePlus   = {jentzsch::reset,        jentzsch::map,       no_hidden_page, jentzsch::write,       jentzsch::admits};
constexpr MapperOps kFa2      = {starcastle::reset,      starcastle::map,     starcastle::read, starcastle::write,   starcastle::admits};
constexpr MapperOps kEff      = {savecircuit::reset,     savecircuit::map,    savecircuit::read, savecircuit::write, savecircuit::admits, savecircuit::power_on};
constexpr MapperOps kFc       = {amiga::reset,           amiga::map,          amiga::read,    amiga::write,          amiga::admits};
constexpr MapperOps kSb       = {superbank::reset,       ua::map,             ua::read<superbank::touch>, ua::write<superbank::touch>,     superbank::admits};
constexpr MapperOps kMdm      = {superbank::reset_mdm,   ua::map,             ua::read<superbank::touch_mdm>, ua::write<superbank::touch_mdm>, superbank::admits_mdm};
constexpr MapperOps k03e0     = {parker::reset,          parker::map_03e0,    ua::read<parker::touch_03e0>, ua::write<parker::touch_03e0>, parker::admits};
constexpr MapperOps kX07      = {atari::reset,           ua::map,             ua::read<atariage::touch>, ua::write<atariage::touch>,       atari::admits};
constexpr MapperOps kWd       = {wickstead::reset,       wickstead::map,      wickstead::read, wickstead::write,     wickstead::admits};
constexpr MapperOps k4a50     = {payson::reset,          payson::map,         no_hidden_page, payson::write,         payson::admits, nullptr, nullptr, payson::observe};
constexpr MapperOps kUa       = ua::kOps<ua::kUa>;
constexpr MapperOps kUaClone  = ua::kOps<ua::kClone>;
constexpr MapperOps kUasw     = ua::kOps<ua::kSwapped>;
constexpr MapperOps k0fa0     = ua::kOps<ua::k0fa0>;
constexpr MapperOps k0840     = ua::kOps<ua::k0840>;
constexpr MapperOps kMany     = {atari::reset_game,      atari::map_game,     no_hidden_page, kIgnore,               no_banks};
constexpr MapperOps kCv       = {commavid::reset_empty,  commavid::map,       no_hidden_page, commavid::write,       no_banks};
constexpr MapperOps kCvFilled = {commavid::reset_filled, commavid::map,       no_hidden_page, commavid::write,       no_banks};
constexpr MapperOps kAr       = {starpath::reset,        starpath::map,       starpath::read, starpath::write,       starpath::admits};
constexpr MapperOps kMb       = {atari::reset,           atari::map,          dynacom::read,  dynacom::write,        atari::admits};
constexpr MapperOps kMc       = {megacart::reset,        megacart::map,       megacart::read, megacart::write,       megacart::admits};

constexpr Scheme many(std::string_view name, std::uint8_t games) {
  return {kMany, name, games * atari::kMinGame, 0, games, 0, 0, false, Watch::kNothing, 0, games * atari::kMaxGame};
}

constexpr unsigned kChip = sizeof(dpc::Chip), kDpcPlusChip = sizeof(dpcplus::Chip);
constexpr unsigned kCdfChip = sizeof(cdf::Chip);

constexpr Scheme cdf_of(std::string_view name, cdf::Version version) {
  return {kCdf, name, cdf::kImage, cdf::kFirstHotSpot, cdf::kBanks, cdf::kFirstBank, cdf::kRam, false, Watch::kNothing, kCdfChip, cdf::kImage, version};
}
constexpr unsigned kDpcPlusLeast = dpcplus::kMinImage, kDpcPlusMost = dpcplus::kMaxImage;

constexpr Scheme kSchemes[] = {
    // ops      name          image  hot spot banks init ram  random  watch
    {kPlain,    "2K",           2048, 0,        1, 0,     0, false},
    {kPlain,    "4K",           4096, 0,        1, 0,     0, false},
    {kPlainSc,  "4KSC",         4096, 0,        1, 0,   128, true},
    {kAtari,    "F8",           8192, 0xFF8,    2, 1,     0, false},
    {kAtari,    "F8 swapped",   8192, 0xFF8,    2, 0,     0, false},
    {kAtari,    "F8SC",         8192, 0xFF8,    2, 1,   128, true},
    {kAtari,    "F6",          16384, 0xFF6,    4, 0,     0, false},
    {kAtari,    "F6SC",        16384, 0xFF6,    4, 0,   128, true},
    {kAtari,    "F4",          32768, 0xFF4,    8, 0,     0, false},
    {kF4sc,     "F4SC",        32768, 0xFF4,    8, 0,   128, true},
    {kAtari,    "FASC",        12288, 0xFF8,    3, 2,   256, true},
    {kFa2,      "FA2",         24576, 0xFF5,    7, 0,   256, true},
    {kJane,     "JANE",        16384, 0xFF0,    4, 0,     0, false},
    {kWf8,      "WF8",          8192, 0xFF8,    2, 0,     0, false},
    {kFc,       "FC",           8192, 0,        0, 0,     0, false},
    {kE0,       "E0",           8192, 0,        0, 0,     0, false},
    {kE7,       "E7",           8192, 0,        0, 0,  2048, true},
    {kFe,       "FE",           8192, 0,        0, 0,     0, false},
    {kDpc,      "DPC",         10240, 0xFF8,    2, 1, kChip, false},
    {kDpcPlus,  "DPC+", kDpcPlusLeast, 0xFF6,   6, 5, dpcplus::kRam, false, Watch::kNothing, kDpcPlusChip, kDpcPlusMost},
    cdf_of("CDF0", cdf::kCdf0), cdf_of("CDF", cdf::kCdf1), cdf_of("CDFJ", cdf::kCdfj),
    {kCdf,      "CDFJ+", cdf::kImage, cdf::kFirstHotSpotPlus, cdf::kBanks, cdf::kFirstBankPlus, cdf::kMaxRamPlus, false, Watch::kNothing, kCdfChip, cdf::kMaxImagePlus, cdf::kCdfjPlus},
    {k3f,       "3F",           2048, 0,        0, 0,     0, false, Watch::kTia},
    {k3e,       "3E",           2048, 0,        0, 0, 32768, true,  Watch::kTia},
    {k3e,       "3EX",          2048, 0,        0, 0, 262144, false, Watch::kTia},
    {k3ePlus,   "3E+",          2048, 0,        0, 0, 32768, true,  Watch::kTia},
    {kUa,       "UA",           8192, 0,        2, 0,     0, false, Watch::kTia},
    {kUaClone,  "UA clone",     8192, 0,        2, 0,     0, false, Watch::kRiot},
    {kUasw,     "UASW",         8192, 0,        2, 0,     0, false, Watch::kRiot},
    {k0fa0,     "0FA0",         8192, 0,        2, 0,     0, false, Watch::kRiot},
    {k0840,     "0840",         8192, 0,        2, 0,     0, false, Watch::kTia},
    {k03e0,     "03E0",         8192, 0,        0, 0,     0, false, Watch::kRiot},
    {kWd,       "WD",           8192, 0,        0, 0,    64, true,  Watch::kTia},
    {kWd,       "WDSW",         8195, 0,        0, 0,    64, true,  Watch::kTia, 0, 8195, wickstead::kSwapped},
    {kCv,       "CV",           2048, 0,        0, 0,  1024, true},
    {kCvFilled, "CV 4K",        4096, 0,        0, 0,  1024, false},
    {kAr,       "AR",           8448, 0,        0, 0,  6144, true},
    {kAtari,    "EF",          65536, 0xFE0,   16, 1,     0, false},
    {kEff,      "EFF",         65536, 0xFE0,   16, 1, savecircuit::kBytes, false, Watch::kNothing, sizeof(savecircuit::Eeprom)},
    {kAtari,    "EFSC",        65536, 0xFE0,   16, 15,  128, true},
    {kAtari,    "DF",         131072, 0xFC0,   32, 1,     0, false},
    {kAtari,    "DFSC",       131072, 0xFC0,   32, 15,  128, true},
    {kAtari,    "BF",         262144, 0xF80,   64, 1,     0, false},
    {kAtari,    "BFSC",       262144, 0xF80,   64, 15,  128, true},
    {kSb,       "SB",         131072, 0,        0, 0,     0, false, Watch::kTia},
    {kMdm,      "MDM",          8192, 0,        0, 0,     0, false, Watch::kMirrors},
    {k4a50,     "4A50", payson::kImage, 0,      0, 0, payson::kRam, true, Watch::kNothing, 0, payson::kImage},
    {kX07,      "X07",         65536, 0,       16, 0,     0, false, Watch::kMirrors},
    many("2IN1", 2), many("4IN1", 4), many("8IN1", 8), many("16IN1", 16), many("32IN1", 32), many("64IN1", 64), many("128IN1", 128),
    {kMb,       "MB",          65536, 0xFF0,   16, 1,     0, false},
    {kMc,       "MC",         131072, 0,        0, 0, 32768, true,  Watch::kTia},
};
// clang-format on

// The games after the first of cartridges with many: "2IN1 2" to "128IN1 128".
struct GameOfMany {
  std::string name;
  Scheme scheme;
};

const std::deque<GameOfMany>& games_of_many() {
  static const std::deque<GameOfMany> all = [] {
    std::deque<GameOfMany> games;
    for (const Scheme& first : kSchemes)
      for (std::uint8_t game = 1; first.map == atari::map_game && game < first.banks; ++game) {
        games.push_back({std::string(first.name) + ' ' + std::to_string(game + 1), first});
        GameOfMany& one = games.back();
        one.scheme.name = one.name;
        one.scheme.initial_bank = game;
      }
    return games;
  }();
  return all;
}

constexpr std::string_view kUnsupported[] = {"BUS", "CM", "CTY", "DEVC", "ELF", "GL", "MVC", "TVBOY"};

[[noreturn]] void refuse_scheme(std::string sentence) {
  std::string_view separator = "; accepted: ";
  for (const Scheme& scheme : kSchemes) sentence.append(std::exchange(separator, ", ")).append(scheme.name);
  throw InvalidInput(sentence);
}

std::string size_text(const Rom& rom) { return std::to_string(rom.size()) + " bytes"; }

// scheme_name(), which must be that of an implemented scheme. An ARM program without a text could be for
// several schemes.
std::string_view detected_scheme(const Rom& rom) {
  if (scheme_by_text(rom).empty() && has_arm_code(rom))
    throw InvalidInput("the image of " + size_text(rom) +
                       " has code for an ARM, and does not show its cartridge scheme; name it: DPC+, CDFJ or "
                       "CDFJ+");
  const std::string_view name = scheme_name(rom);
  if (is_unsupported(name))
    refuse_scheme("the image is for the cartridge scheme " + std::string(name) +
                  ", which is not implemented");
  if (name.empty())
    throw InvalidInput("no cartridge scheme fits an image of " + size_text(rom) +
                       "; usual sizes are 2048, 4096, 8192, 16384 and 32768 bytes");
  return name;
}

void check_image_size(const Rom& rom, const Scheme& scheme) {
  const auto refuse = [&](const char* bound, unsigned bytes) {
    throw InvalidInput("the cartridge scheme " + std::string(scheme.name) + " needs an image of " + bound +
                       " " + std::to_string(bytes) + " bytes; this one has " + size_text(rom));
  };
  if (rom.size() < scheme.least_image) refuse("at least", scheme.least_image);
  if (scheme.most_image != 0 && rom.size() > scheme.most_image) refuse("at most", scheme.most_image);
}

}  // namespace

const Scheme& scheme_named(std::string_view name) {
  const auto scheme = std::ranges::find(kSchemes, name, &Scheme::name);
  if (scheme != std::end(kSchemes)) return *scheme;
  const auto game = std::ranges::find(games_of_many(), name, &GameOfMany::name);
  if (game != games_of_many().end()) return game->scheme;
  refuse_scheme((is_unsupported(name) ? "unsupported cartridge scheme '" : "unknown cartridge scheme '") +
                std::string(name) + "'");
}

const Scheme& scheme_of(const Rom& rom, std::string_view requested) {
  const Scheme& scheme = scheme_named(requested.empty() ? detected_scheme(rom) : requested);
  check_image_size(rom, scheme);
  return scheme;
}

std::span<const std::string_view> unsupported_schemes() { return kUnsupported; }

bool is_unsupported(std::string_view name) {
  return std::ranges::find(kUnsupported, name) != std::end(kUnsupported);
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
