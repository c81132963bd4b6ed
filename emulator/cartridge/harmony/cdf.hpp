// CDF, CDFJ and CDFJ+, of homebrew games since 2016: seven banks of 4K, streams that read display data in
// RAM, jumps through one or two of them, three voices or a sample, and an ARM, whose Thumb code the program
// calls (docs/spec/cartridges.md, 15).
//
// While "fast fetch" is on, the cartridge follows each instruction. All its pages are then hidden, as they
// are while a call of the ARM is pending. At other times code is plain memory, as in other schemes.
#pragma once

#include <array>
#include <cstdint>

#include "emulator/cartridge/cartridge.hpp"
#include "emulator/cartridge/harmony/harmony.hpp"

namespace racebeam::cdf {

constexpr unsigned kBanks = 7, kBankSize = 4096, kImage = 32768, kRam = 8192;
constexpr unsigned kMaxImagePlus = 524288, kMaxRamPlus = 32768;
constexpr unsigned kFirstBank = 6, kFirstBankPlus = 0;                // the initial ones
constexpr unsigned kFirstHotSpot = 0xFF5, kFirstHotSpotPlus = 0xFF4;  // that select banks
enum Version : std::uint8_t { kCdf0, kCdf1, kCdfj, kCdfjPlus };       // Scheme::version
constexpr std::uint8_t kMinWave = 20, kMaxWave = 31;                  // sizes

// Stored and used in the bytes of the state in which other schemes have RAM. Pointers, increments and
// waveforms are in the RAM of the ARM.
struct Chip {
  harmony::Clock clock;
  harmony::Follower follower;
  std::array<std::uint8_t, 3> wave;  // by voice: how many low bits of the phase are a fraction of a byte
  std::uint8_t plays_waves;          // 1: three voices; 0: a sample
  std::uint8_t jump;                 // the stream that gives the second byte of a jump's address; 0: none
  std::uint8_t stopped;              // 1: a call did not return, and the ARM executes no more
  std::uint8_t loads;                // kLoadsX, kLoadsY: LDX # and LDY # read streams, too
  std::uint8_t first_stream;         // the operand of LDA # that reads stream 0
};
constexpr std::uint8_t kLoadsX = 1, kLoadsY = 2, kMaxFirstStream = 220;
static_assert(sizeof(Chip) <= kRamInState && std::has_unique_object_representations_v<Chip>);
static_assert(alignof(Chip) <= alignof(CartridgeState));

using enum harmony::Bank;

void reset(CartridgeSlot& slot);
void map(CartridgeSlot& slot);
bool admits(const CartridgeSlot& slot, const CartridgeState& state);
std::uint8_t read(CartridgeSlot& slot, std::uint16_t address, std::int32_t cycle);
Delivery write(CartridgeSlot& slot, std::uint16_t address, std::uint8_t value);

}  // namespace racebeam::cdf
