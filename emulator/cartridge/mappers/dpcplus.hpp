// DPC+, of homebrew games since 2010: six banks of 4K, eight fetchers that read and write 4K of display data
// in RAM, eight that read it in fractional steps, random numbers, three voices, and an ARM, whose Thumb code
// the program calls (docs/spec/cartridges.md, 14).
//
// While "fast fetch" is on, the cartridge follows each instruction. All its pages are then hidden, and while
// a call of the ARM waits, too. In between, code is plain memory, as in other schemes.
#pragma once

#include <array>
#include <cstdint>

#include "emulator/cartridge/cartridge.hpp"

namespace racebeam::dpcplus {

constexpr unsigned kDriver = 3072, kBanks = 6, kBankSize = 4096, kDisplaySize = 4096, kFrequencies = 1024;
constexpr unsigned kRam = kDriver + kDisplaySize + kFrequencies;
constexpr unsigned kLeastImage = kBanks * kBankSize + kDisplaySize + kFrequencies;  // without a driver
constexpr unsigned kMostImage = kDriver + kLeastImage;

// The ARM's time. An endless call ends when all is used up. A frame that does not end gives no more of it.
constexpr std::uint32_t kInstructionsPerCycle = 16, kMostInstructions = 1U << 19;
constexpr std::int32_t kCyclesOfFrame = 32768;

struct Fetcher {
  std::uint16_t pointer;  // 12 bits
  std::uint8_t top, bottom;
};

struct FractionalFetcher {
  std::uint16_t pointer;  // 12 bits
  std::uint8_t fraction, step;
};

struct Voice {
  std::uint32_t frequency, phase;
};

// Stored and used in the bytes of the state in which other schemes have RAM.
struct Chip {
  std::array<Fetcher, 8> fetcher;
  std::array<FractionalFetcher, 8> fractional;
  std::array<Voice, 3> voice;
  std::uint32_t random;
  std::uint32_t instructions;  // that the ARM may execute
  std::uint32_t into_sample;   // kSampleParts are a sample
  std::array<std::uint8_t, 8> parameter;
  std::array<std::uint8_t, 3> waveform;  // 7 bits
  std::uint8_t parameters;               // that were written
  std::uint16_t next;                    // fast fetch: address of the instruction's next byte
  std::uint8_t missing;                  // and how many bytes it has from there on
  std::uint8_t loads;                    // it is LDA #
  std::uint8_t stopped;                  // the ARM stands still
  std::uint8_t spare[3];
};
static_assert(sizeof(Chip) <= kRamInState && std::has_unique_object_representations_v<Chip>);
static_assert(alignof(Chip) <= alignof(CartridgeState));

constexpr unsigned kSampleParts = 143183;  // 3579575 / 3 / 20000 cycles are a sample, or 143183 / 2400

enum Bank { kShown, kFastFetch, kCalled };  // among the state's banks

void reset(CartridgeSlot& slot);
void map(CartridgeSlot& slot);
bool admits(const CartridgeSlot& slot, const CartridgeState& state);
std::uint8_t read(CartridgeSlot& slot, std::uint16_t address, std::int32_t cycle);
Delivery write(CartridgeSlot& slot, std::uint16_t address, std::uint8_t value);
PortReader port_reader(std::uint16_t address);

}  // namespace racebeam::dpcplus
