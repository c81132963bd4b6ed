// Every byte of a machine that persists from one instruction to the next, and nothing else. Saving is a copy,
// comparing is memcmp. Derived data (memory map, object masks) and outputs (pictures, sound) are beside it.
// All clocks count from the start of the frame; see emulator/README.md.
#pragma once

#include <array>
#include <cstdint>
#include <type_traits>

#include "emulator/state/inputs.hpp"

namespace racebeam {

struct CpuState {
  std::uint16_t PC = 0;
  std::uint8_t A = 0, X = 0, Y = 0, SP = 0xFF;
  std::uint8_t P = 0;       // N V - - D I Z C; the two middle bits are never stored
  std::uint8_t jammed = 0;  // the CPU has stopped at an opcode that halts it
  std::uint8_t latch = 0;   // last value on the data bus
  std::uint8_t spare[3]{};
};

struct RiotState {
  std::array<std::uint8_t, 128> ram{};
  std::uint32_t timer_set = 0;  // cycle at which the timer was written
  std::uint32_t late_read = 0;  // cycle of the first read after it ran out
  std::uint8_t timer = 0;       // value written
  std::uint8_t shift = 0;       // log2 of the interval
  std::uint8_t late = 0;        // whether late_read is valid
  std::uint8_t swacnt = 0;
};

struct PlayerState {
  std::uint8_t grp = 0, old_grp = 0;
  std::uint8_t refp = 0, vdel = 0;
  std::uint8_t nusiz = 0;     // copies of player and missile; size of the missile
  std::uint8_t position = 0;  // 0-159
  std::uint8_t motion = 0;    // HMPx >> 4
  std::uint8_t skip = 0;      // the first copy is left out until the end of the line
};

struct MissileState {
  std::uint8_t enabled = 0, locked = 0;  // ENAMx, RESMPx
  std::uint8_t position = 0, motion = 0;
};

struct BallState {
  std::uint8_t enabled = 0, old_enabled = 0, vdel = 0;
  std::uint8_t position = 0, motion = 0;
};

enum class CosmicShape : std::uint8_t { kNormal, kStretched, kHidden };

// The registers that determine the pixels of a line. They change with register writes and at the end of a
// line.
struct TiaRegisters {
  std::array<std::uint8_t, 4> color{};  // COLUP0 COLUP1 COLUPF COLUBK
  std::uint8_t ctrlpf = 0;
  std::uint8_t reflect = 0;          // latch of CTRLPF bit 0
  std::array<std::uint8_t, 3> pf{};  // PF0 PF1 PF2
  std::array<PlayerState, 2> player{};
  std::array<MissileState, 2> missile{};
  BallState ball;
  std::uint8_t vblank = 0;      // VBLANK bit 1
  std::uint8_t comb_armed = 0;  // the next line start is blanked by an HMOVE
  std::uint8_t cosmic = 0;      // missile 0 moves by itself (docs/spec/tia.md, "Cosmic Ark mode")
  std::uint8_t cosmic_count = 0;
  CosmicShape cosmic_shape = CosmicShape::kNormal;
  std::uint8_t enabled = 0;  // enabled_objects(), kept up to date
  std::uint8_t spare[4]{};   // padding to whole words: lines are compared and masked by words
};

// The picture side of the TIA: registers, and where the beam is.
struct TiaState : TiaRegisters {
  std::int32_t origin = 0;        // F: colour clock at which line 0 of the frame starts, <= 0
  std::int32_t cursor = 0;        // L: drawn up to this colour clock
  std::int32_t left = 228;        // E: clocks left on the cursor's line; 0: its end is still to be processed
  std::int32_t pixel = 0;         // index of the next pixel in the picture
  std::uint32_t hmove_clock = 0;  // of the last HMOVE
  std::uint16_t collisions = 0;   // one bit a pair of objects, see line.hpp
  std::uint8_t spare_bytes[2]{};

  TiaRegisters& registers() { return *this; }
};

// The part of the TIA that the CPU sees at once: frames, and the capacitors behind the paddles.
struct FrameState {
  std::uint32_t vsync_finish = 0x7FFFFFFF;  // from this clock on, ending VSYNC closes the frame
  std::uint32_t dump_release = 0;           // cycle at which the capacitors were released
  std::int32_t lines = 0;                   // of the last completed frame
  std::uint8_t dumping = 0;                 // VBLANK bit 7
  std::uint8_t open = 0;                    // the last step ended without closing its frame
  std::uint8_t greyed = 0;                  // the undrawn rows of that frame have been greyed
  std::uint8_t swcha = 0;                   // what was written to SWCHA; 0 unless a keyboard needs it
  std::uint32_t cartridge_clock = 0;        // cycle of the last access to a cartridge with a clock (DPC)
};

struct CartridgeState {
  std::array<std::uint8_t, 8> bank{};  // what each window shows, as the scheme defines it
  // on-board RAM, or registers; larger RAM is beside the state (cartridge.hpp)
  alignas(4) std::array<std::uint8_t, 256> ram{};
};

// An upper limit of T between two steps. Only a program that never closes its frame comes near it.
constexpr std::int32_t kEndlessCycle = 1 << 29;

struct State {
  std::int32_t cycle = 0;   // T: CPU cycles since the frame started
  std::uint32_t drawn = 0;  // draws taken from the power-on generator
  CpuState cpu;
  RiotState riot;
  TiaState tia;
  FrameState frame;
  CartridgeState cartridge;
  Inputs inputs;
};

static_assert(sizeof(TiaRegisters) == 48);
static_assert(std::is_trivially_copyable_v<State>);
static_assert(std::has_unique_object_representations_v<State>);  // no padding, no floats
static_assert(sizeof(State) <= 640);

}  // namespace racebeam
