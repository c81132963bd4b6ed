// DPC+, of homebrew games since 2010: six banks of 4K, eight fetchers that read and write 4K of display data
// in RAM, eight that read it in fractional steps, random numbers, three voices, and an ARM, whose Thumb code
// the program calls (docs/spec/cartridges.md, 14).
//
// While "fast fetch" is on, the cartridge follows each instruction. All its pages are then hidden, as they
// are while a call of the ARM is pending. At other times code is plain memory, as in other schemes.
#pragma once

#include <array>
#include <cstdint>

#include "emulator/cartridge/cartridge.hpp"
#include "emulator/cartridge/harmony/harmony.hpp"

namespace racebeam::dpcplus {

constexpr unsigned kDriver = 3072, kBanks = 6, kBankSize = 4096, kDisplaySize = 4096, kFrequencies = 1024;
constexpr unsigned kRam = kDriver + kDisplaySize + kFrequencies;
constexpr unsigned kMinImage = kBanks * kBankSize + kDisplaySize + kFrequencies;  // without a driver
constexpr unsigned kMaxImage = kDriver + kMinImage;

struct Fetcher {
  std::uint16_t pointer;  // 12 bits
  std::uint8_t top, bottom;
};

struct FractionalFetcher {
  std::uint16_t pointer;  // 12 bits
  std::uint8_t fraction, step;
};

// Stored and used in the bytes of the state in which other schemes have RAM.
struct Chip {
  std::array<Fetcher, 8> fetcher;
  std::array<FractionalFetcher, 8> fractional;
  harmony::Clock clock;
  std::uint32_t random;
  std::array<std::uint8_t, 8> parameter;
  std::array<std::uint8_t, 3> waveform;  // 7 bits
  std::uint8_t parameters;               // how many of them have been written
  harmony::Follower follower;            // of fast fetch
  std::uint8_t stopped;                  // 1: a call did not return, and the ARM executes no more
  std::uint8_t spare[3];
};
static_assert(sizeof(Chip) <= kRamInState && std::has_unique_object_representations_v<Chip>);
static_assert(alignof(Chip) <= alignof(CartridgeState));

using enum harmony::Bank;

void reset(CartridgeSlot& slot);
void map(CartridgeSlot& slot);
bool admits(const CartridgeSlot& slot, const CartridgeState& state);
std::uint8_t read(CartridgeSlot& slot, std::uint16_t address, std::int32_t cycle);
Delivery write(CartridgeSlot& slot, std::uint16_t address, std::uint8_t value);
PortReader port_reader(std::uint16_t address);

}  // namespace racebeam::dpcplus
