// A cartridge scheme is one record. A cartridge shows plain memory to the CPU through the memory map. It acts
// only where its pages are hidden: hot spots and write ports (docs/spec/cartridges.md).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "emulator/cartridge/memory_map.hpp"
#include "emulator/state/state.hpp"

namespace racebeam {

using Rom = std::vector<std::uint8_t>;

struct Scheme;

// The cartridge in the console's slot: its image, its scheme, its part of the machine's state, and the memory
// map.
struct CartridgeSlot {
  const Rom& rom;
  const Scheme& scheme;
  State& machine;
  std::span<std::uint8_t> ram;  // the scheme's RAM: in the state if it fits there, otherwise beside it
  MemoryMap& map;
  CartridgeState& state = machine.cartridge;
};

// Whether a write ends at the cartridge, or continues to the TIA.
enum class Delivery : bool { kTaken, kToTia };

// An access of the CPU to the operand of an instruction.
struct Access {
  std::uint16_t address;
  std::uint8_t value;   // read or written; for both, the one that was written
  std::uint8_t before;  // the byte that the CPU read before this access
  bool writes;          // whether the access is a write
};

using PortReader = std::uint8_t (*)(CartridgeSlot&, std::uint16_t address, std::int32_t cycle);

struct MapperOps {
  void (*reset)(CartridgeSlot&);  // sets the initial banks
  void (*map)(CartridgeSlot&);    // maps what the banks select
  PortReader read;                // reads a hidden page, or watches a read of the TIA or the RIOT
  // Handles a write to a cartridge address, or watches one to the TIA or the RIOT.
  Delivery (*write)(CartridgeSlot&, std::uint16_t address, std::uint8_t value);

  // Whether the cartridge can be in `state`, which comes from an untrusted source. It must check every value
  // that selects or indexes something, but not the bytes after the scheme's RAM.
  bool (*admits)(const CartridgeSlot&, const CartridgeState& state);

  void (*power_on)(CartridgeSlot&) = nullptr;  // sets the values that are not zero before the first reset

  // For translated code: the function that does the work of `read` at `address`. Null if that may select a
  // bank.
  PortReader (*port_reader)(std::uint16_t address) = nullptr;

  // Sees all accesses to operands, also to RAM, when their instruction has ended. Such a cartridge is
  // interpreted, one instruction at a time.
  void (*observe)(CartridgeSlot&, const Access&) = nullptr;
};

struct Scheme : MapperOps {
  // The accesses that a cartridge sees besides those to its own addresses. Each value includes those before
  // it.
  enum class Watch : std::uint8_t {
    kNothing,
    kTia,
    kRiot,    // its ports and its timer
    kMirrors  // RAM at addresses with bit 11 set. Such a cartridge is interpreted. Other RAM is never watched
  };

  std::string_view name;
  unsigned least_image;       // bytes of the smallest image
  unsigned first_hot_spot;    // offset in the 4K of the cartridge; 0 if the mapper has constants for its own
  std::uint8_t banks;         // their number, or that of games; 0 if the mapper does not need it
  std::uint8_t initial_bank;  // the one that a reset selects; for one of many games, its number from 0
  unsigned ram_bytes;         // RAM on the cartridge, or registers that are stored in its place
  bool random_ram;            // every reset fills the RAM with random bytes
  Watch watch = Watch::kNothing;
  unsigned register_bytes = 0;  // registers in CartridgeState::ram, if the RAM itself is too large for that
  unsigned most_image = 0;      // bytes of the largest image; 0: no limit, and only the first bytes are used
  std::uint8_t version = 0;     // distinguishes schemes that share their functions

  bool watches(Watch accesses) const { return watch >= accesses; }
};

// RAM up to this size is part of the state. Larger RAM has a block of its own, which keeps the state of most
// cartridges small.
constexpr std::size_t kRamInState = std::tuple_size_v<decltype(CartridgeState::ram)>;

// For MapperOps::admits: true if all banks from `first` on are unused (0).
inline bool banks_unused(const CartridgeState& state, std::size_t first) {
  return std::all_of(state.bank.begin() + static_cast<std::ptrdiff_t>(first), state.bank.end(),
                     [](std::uint8_t bank) { return bank == 0; });
}

// The scheme with that name. Throws InvalidInput, with the implemented names, if it is not implemented.
const Scheme& scheme_named(std::string_view name);

// The scheme with the requested name; without a name, the one that the size and the signatures of the image
// indicate. Throws InvalidInput if no scheme fits, the scheme is not implemented, or the image is too small
// or too large for it.
const Scheme& scheme_of(const Rom& rom, std::string_view requested = {});

// The name of the scheme that the size and the signatures indicate; empty if no scheme fits.
std::string_view scheme_name(const Rom& rom);

// Whether no instruction in the image accesses a hot spot of the scheme, so that the image is unlikely to
// have that scheme. Always false for schemes other than those with banks of 4K and a row of hot spots
// (Scheme::first_hot_spot).
bool accesses_no_hot_spot(const Rom& rom, const Scheme& scheme);

// The names that can be requested, without those of the second and later games of cartridges with many.
std::span<const std::string_view> scheme_names();

// Names of schemes that are not implemented (docs/spec/cartridges.md, 11).
std::span<const std::string_view> unsupported_schemes();
bool is_unsupported(std::string_view name);

}  // namespace racebeam
