// The board as the CPU sees it. It decodes addresses and owns the chips (docs/spec/cpu.md, 2;
// docs/spec/riot.md; docs/spec/tia.md).
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <vector>

#include "emulator/board/board_memory.hpp"
#include "emulator/board/ports.hpp"
#include "emulator/tia/registers/motion.hpp"
#include "emulator/tia/tia.hpp"

namespace racebeam {

class Board : public BoardMemory {
 public:
  Board(std::shared_ptr<const Rom> rom, const Properties& properties);
  Board(const Board&) = delete;
  Board& operator=(const Board&) = delete;

  Video video;
  Tia tia;
  std::vector<std::uint8_t> cartridge_ram;  // RAM that does not fit into the state; empty for most schemes
  WriteLog* log = nullptr;                  // of the step in progress

  // Read a byte for the CPU: from any address, and from an address that the memory map does not show. latch:
  // the byte on the data bus before the access. cycle: that of the access, as in all functions here.
  std::uint8_t read(std::uint16_t address, std::uint8_t latch, std::int32_t cycle);
  std::uint8_t read_device(std::uint16_t address, std::uint8_t latch, std::int32_t cycle);

  // Returns the bytes of the instruction at `pc`. Moves the code window there if plain memory holds them,
  // else reads them over the bus.
  const std::uint8_t* locate_code(std::uint16_t pc, std::uint8_t latch, std::int32_t cycle);

  // Returns the cycle after the write. WSYNC waits for the end of the line if the access before it was a read
  // (`after_read`).
  std::int32_t write_device(std::uint16_t address, std::uint8_t value, std::int32_t cycle, bool after_read);

  // Whether a TIA write goes to the log and has no other effect. Never true in an exact step.
  bool is_plain_write(std::uint16_t address, std::int32_t cycle) const {
    if (cycle >= overlong_cycle_) [[unlikely]]
      return false;
    return (plain_registers_ >> (address & 0x3F) & 1) != 0;
  }

  // WSYNC after a read: the CPU stops until the next line starts. Returns false, and does nothing, if
  // write_device() must handle it.
  RACEBEAM_INLINE bool wait_for_line(std::uint16_t address, std::int32_t& cycle) {
    if ((address & 0x3F) != WSYNC || plain_registers_ == 0 || cycle >= overlong_cycle_) return false;
    if (log->is_short_of_room(cycle)) [[unlikely]]
      return false;
    last_access = cycle;
    cycle += (overlong_cycle_ - cycle) % kLineCycles;
    return true;
  }

  // Moves the code window to `pc`. Returns false if plain memory is missing there, or too short for an
  // instruction.
  bool find_code(std::uint16_t pc);

  // For the translator: the TIA registers whose writes only go to the log, and the cycle from which a write
  // closes the frame.
  std::uint64_t plain_registers() const;
  std::int32_t overlong_cycle() const { return overlong_cycle_; }

  void open_frame();  // docs/spec/tia.md, 2: action 1 of a step; the pictures have been exchanged already
  void turn_back_clocks(std::int32_t cycles);
  // A step is begin_step(), then the CPU, then end_step(), which draws as far as the reference does. If
  // needs_exact_step() then returns true, pixels are visible that the reference draws ahead of the beam. The
  // caller must repeat the step from the state before it, with RenderMode::kExact. picture: receives the
  // pixels. other: the other frame buffer, whose rows may be copied, or null. scratch: the log to use.
  // sought: with RenderMode::kNone, the pairs whose collisions are computed.
  void begin_step(FrameBuffer& picture, const FrameBuffer* other, WriteLog& scratch,
                  RenderMode mode = RenderMode::kDrawn, Collisions sought = kAllPairs);
  void end_step();
  // Whether the log has all writes of the step that has ended. record_step(), which requires that, stores
  // them for replay(). start, lines: the TIA, and FrameState::lines, before the step.
  bool is_recorded() const { return log->is_whole; }
  void record_step(RecordedStep& step, const TiaState& start, std::int32_t lines) const;
  // Replays the writes of a step on its `picture`, as described at begin_step(). Returns the collisions at
  // its end. The machine does not change.
  Collisions replay(const RecordedStep& step, FrameBuffer& picture, const FrameBuffer* other,
                    RenderMode mode);
  bool needs_exact_step() const;
  void set_format_limits();  // after `video` or the frame's origin has changed

  // Whether translated code cannot handle some accesses: a pin that follows the beam, or watched RAM.
  bool must_be_interpreted() const {
    return ports_.has_light_gun() || slot.scheme.watches(Scheme::Watch::kMirrors) ||
           slot.scheme.observe != nullptr;
  }

  // For a cartridge that sees all accesses to operands.
  void observe(const Access& access);

  // An address is in RAM, and no cartridge watches it, if `address & ram_select_bits` is $80.
  const std::uint16_t ram_select_bits;

  void map_memory();                 // rebuilds everything that is derived from the state, after a reset
  void restore(const State& other);  // replaces the state

 private:
  class PresentState;

  std::uint8_t read_cartridge(std::uint16_t address, std::int32_t cycle);
  [[gnu::noinline]] Delivery write_cartridge(std::uint16_t address, std::uint8_t value);
  std::uint8_t read_tia(std::uint16_t address, std::uint8_t latch, std::int32_t cycle);
  std::uint8_t read_riot(std::uint16_t address, std::int32_t cycle);
  void write_riot(std::uint16_t address, std::uint8_t value, std::int32_t cycle);
  void write_port(unsigned reg, std::uint8_t value);
  std::uint8_t read_watched(std::uint16_t address, std::int32_t cycle);
  void write_watched(std::uint16_t address, std::uint8_t value, std::int32_t cycle);
  std::uint8_t pin(unsigned number, std::int32_t cycle) const {
    return static_cast<std::uint32_t>(cycle) >= pin_high_from[number] ? 0x80 : 0;
  }
  [[gnu::noinline]] bool gun_sees_beam(unsigned side, std::int32_t cycle) const;
  std::int32_t write_tia(std::uint16_t address, std::uint8_t value, std::int32_t cycle, bool after_read);
  void close_frame();
  void write_vsync(std::uint8_t value, std::int32_t cycle);
  void write_dump(bool on, std::int32_t cycle);
  void set_pins();
  [[gnu::noinline]] std::int32_t write_anywhere(std::uint16_t address, std::uint8_t value, std::int32_t cycle,
                                                bool after_read);
  std::int32_t write_wsync(std::int32_t cycle, bool after_read);
  void touch_tia(std::int32_t cycle);
  void make_room(std::int32_t cycle);
  std::uint8_t collision_bits(unsigned reg, std::int32_t cycle);

  std::uint64_t selected_banks() const { return std::bit_cast<std::uint64_t>(state.cartridge.bank); }
  const std::uint8_t* fetch_slowly(std::uint16_t pc, std::uint8_t latch, std::int32_t cycle);
  const std::uint8_t* give_up_step(std::uint16_t pc);

  // An entry of the cache of find_code(). 24 bytes.
  struct KnownWindow {
    std::uint64_t banks = 0;
    const std::uint8_t* memory = nullptr;
    std::uint16_t first = 0, span = 0;
    unsigned slice = ~0U;  // the address divided by 1K; no address has ~0
  };

  std::shared_ptr<const Rom> rom_;
  std::array<KnownWindow, 64> known_windows_{};
  Ports ports_;
  const bool has_gun_ = ports_.has_light_gun();
  const std::uint32_t unwatched_;  // the bit of addresses that only the RIOT sees; 0 if the cartridge watches
  std::uint64_t plain_registers_ = 0;
  // The first cycle, at a line's start, from which a TIA write closes the frame.
  std::int32_t overlong_cycle_ = 0;
  std::array<std::uint8_t, 3> fetched_{};  // an instruction that is not in plain memory
  bool exact_mode_ = false;                // each access is played on its own
  bool picture_is_exact_ = true;           // of the last step, even if it ran in another mode
  bool fetched_latches_ = false;  // an opcode was to be fetched from a collision register, and ended the step
};

}  // namespace racebeam
