// The board as the CPU sees it: decodes addresses and owns the chips (docs/spec/cpu.md, 2;
// docs/spec/riot.md; docs/spec/tia.md).
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <vector>

#include "emulator/board/context.hpp"
#include "emulator/board/ports.hpp"
#include "emulator/cartridge/cartridge.hpp"
#include "emulator/cartridge/memory_map.hpp"
#include "emulator/state/state.hpp"
#include "emulator/tia/registers/motion.hpp"
#include "emulator/tia/sound.hpp"
#include "emulator/tia/tia.hpp"

namespace racebeam {

namespace translator { struct Layout; }

class Board {
 public:
  Board(std::shared_ptr<const Rom> rom, const Properties& properties);
  Board(const Board&) = delete;
  Board& operator=(const Board&) = delete;

  State state;
  MemoryMap map;
  Video video;
  Tia tia;
  Sound sound;
  Slot slot;
  std::vector<std::uint8_t> cartridge_ram;  // what doesn't fit into the state; mostly none
  WriteLog* log = nullptr;  // of the step that runs
  CodeWindow code;    // where the CPU fetches; nowhere after the map has changed, and when the frame has closed
  bool stop = false;  // the frame has closed: the CPU ends after this instruction

  // What the CPU does where there is no plain memory. `latch` is the data bus before the access.
  std::uint8_t read(std::uint16_t address, std::uint8_t latch, std::int32_t cycle);  // plain memory or a device
  std::uint8_t read_device(std::uint16_t address, std::uint8_t latch, std::int32_t cycle);

  // The bytes of the instruction at `pc`: moves the code window there, or, where there is no plain memory or too little
  // of it, reads them over the bus.
  const std::uint8_t* locate_code(std::uint16_t pc, std::uint8_t latch, std::int32_t cycle);

  // Returns the cycle after the write: WSYNC waits for the end of the line when the access before it was a read.
  std::int32_t write_device(std::uint16_t address, std::uint8_t value, std::int32_t cycle, bool after_read);

  // A TIA write that only concerns the picture: the log is all it needs. There is none in an exact step.
  bool is_plain_write(std::uint16_t address, std::int32_t cycle) const {
    if (cycle >= overlong_cycle_) [[unlikely]] return false;
    return (plain_registers_ >> (address & 0x3F) & 1) != 0;
  }

  // WSYNC, when the access before was a read: the CPU stands still until the next line starts. False, and nothing is done,
  // if that takes write_device().
  RACEBEAM_INLINE bool wait_for_line(std::uint16_t address, std::int32_t& cycle) {
    if ((address & 0x3F) != WSYNC || plain_registers_ == 0 || cycle >= overlong_cycle_) return false;
    if (log->is_short_of_room(cycle)) [[unlikely]] return false;
    last_access_ = cycle;
    cycle += (overlong_cycle_ - cycle) % kLineCycles;
    return true;
  }

  // Moves the code window to `pc`. False where there is no plain memory, or less than an instruction needs.
  bool find_code(std::uint16_t pc);

  // For the translator: TIA writes that only go to the log, and the cycle from which on they close the frame.
  std::uint64_t plain_registers() const;
  std::int32_t overlong_cycle() const { return overlong_cycle_; }
  translator::Context translated;

  void open_frame();  // docs/spec/tia.md, 2: action 1 of a step, with the pictures exchanged already
  void turn_back_clocks(std::int32_t cycles);
  // A step: begin_step(), then what the CPU does, then end_step(), which leaves the picture drawn as far as the
  // reference has drawn it. If needs_exact_step(), what the reference draws ahead of the beam can be seen: then the
  // same is to be done again, from the state before the step, with RenderMode::kExact.
  void begin_step(FrameBuffer& picture, const FrameBuffer* other, WriteLog& scratch,
                  RenderMode mode = RenderMode::kDrawn, Collisions sought = kAllPairs);
  void end_step();
  bool needs_exact_step() const;
  void set_format_limits();  // after `video` or the frame's origin have changed

  void map_memory();               // everything that is derived from the state: after a reset
  void restore(const State& other);  // goes on from there

 private:
  friend translator::Layout;

  std::uint8_t read_cartridge(std::uint16_t address, std::int32_t cycle);
  [[gnu::noinline]] Delivery write_cartridge(std::uint16_t address, std::uint8_t value);
  std::uint8_t read_tia(std::uint16_t address, std::uint8_t latch, std::int32_t cycle);
  std::uint8_t read_riot(std::uint16_t address, std::int32_t cycle);
  void write_riot(std::uint16_t address, std::uint8_t value, std::int32_t cycle);
  std::int32_t write_tia(std::uint16_t address, std::uint8_t value, std::int32_t cycle, bool after_read);
  void close_frame();
  void write_vsync(std::uint8_t value, std::int32_t cycle);
  void write_dump(bool on, std::int32_t cycle);
  [[gnu::noinline]] std::int32_t write_anywhere(std::uint16_t address, std::uint8_t value, std::int32_t cycle,
                                                bool after_read);
  std::int32_t write_wsync(std::int32_t cycle, bool after_read);
  void touch_tia(std::int32_t cycle);
  void make_room(std::int32_t cycle);
  std::uint8_t collision_bits(unsigned reg, std::int32_t cycle);

  std::uint64_t selected_banks() const { return std::bit_cast<std::uint64_t>(state.cartridge.bank); }
  const std::uint8_t* fetch_slowly(std::uint16_t pc, std::uint8_t latch, std::int32_t cycle);

  struct KnownWindow {  // in three words
    std::uint64_t banks = 0;
    const std::uint8_t* memory = nullptr;
    std::uint16_t first = 0, span = 0;
    unsigned slice = ~0U;
  };

  std::shared_ptr<const Rom> rom_;
  std::array<KnownWindow, 64> known_windows_{};
  Ports ports_;
  std::uint64_t plain_registers_ = 0;
  std::int32_t overlong_cycle_ = 0;  // from this cycle on, which starts a line, a TIA write closes the frame
  std::array<std::uint8_t, 3> fetched_{};  // an instruction that is not in plain memory
  std::int32_t last_access_ = 0;     // cycle of the last TIA access but plain writes: how far the picture is drawn
  bool exact_mode_ = false;               // each access is played on its own
  bool picture_is_exact_ = true;             // the picture of the step that has ended is as if it had been
  bool fetched_latches_ = false;     // an opcode was read from a collision register
};

}  // namespace racebeam
