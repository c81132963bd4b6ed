// What a cartridge scheme is: one record. A cartridge shows plain memory to the CPU through the memory map and ops
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

// A cartridge at work: its image, its part of the machine's state, and what the CPU sees of it.
struct Slot {
  const Rom& rom;
  const Scheme& scheme;
  State& machine;
  std::span<std::uint8_t> ram;  // the scheme's: in the state if it fits there, else beside it
  MemoryMap& map;
  CartridgeState& state = machine.cartridge;
};

// What happens to a write once the cartridge has seen it.
enum class Delivery : bool { kTaken, kToTia };

using PortReader = std::uint8_t (*)(Slot&, std::uint16_t address, std::int32_t cycle);

struct MapperOps {
  void (*reset)(Slot&);  // initial banks
  void (*map)(Slot&);    // shows what the banks select
  PortReader read;       // of a hidden page, or seen at the TIA
  Delivery (*write)(Slot&, std::uint16_t address, std::uint8_t value);  // of any cartridge address, or seen at the TIA

  // Can the cartridge be in `state`, which comes from elsewhere? Whatever indexes or selects something has to be
  // looked at; bytes behind the scheme's RAM are not its business.
  bool (*admits)(const Slot&, const CartridgeState& state);

  void (*power_on)(Slot&) = nullptr;  // what is not zero before the first reset

  // For code that knows its addresses beforehand: what does the work of `read` there. Null where that may select a bank.
  PortReader (*port_reader)(std::uint16_t address) = nullptr;
};

struct Scheme : MapperOps {
  std::string_view name;
  unsigned image;          // bytes of an image, at least
  unsigned hotspot;        // Atari's family: offset in 4K of the first hot spot, number of banks, initial bank
  std::uint8_t banks, initial;
  unsigned ram;            // bytes on the cartridge, or of its registers
  bool random_ram;         // filled at every reset
  bool watches_tia;        // takes part in accesses to the TIA's addresses
};

// RAM of at most this size is part of the state; larger RAM lies in a block of its own, so that the state of the many
// cartridges that have little stays small.
constexpr std::size_t kRamInState = std::tuple_size_v<decltype(CartridgeState::ram)>;

// From window `first` on, a scheme has none: for MapperOps::admits.
inline bool banks_unused(const CartridgeState& state, std::size_t first) {
  return std::all_of(state.bank.begin() + static_cast<std::ptrdiff_t>(first), state.bank.end(),
                     [](std::uint8_t bank) { return bank == 0; });
}

// The scheme of an image by its size and signatures, or the one that is asked for by name. Throws
// InvalidInput when none fits, no scheme has that name, or the image is too small for it.
const Scheme& scheme_of(const Rom& rom, std::string_view asked_for = {});

// The detected name; empty when none fits.
std::string_view scheme_name(const Rom& rom);

// All names that can be asked for.
std::span<const std::string_view> scheme_names();

}  // namespace racebeam
