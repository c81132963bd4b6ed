#include "emulator/board/board.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <utility>

#include "emulator/base/opcodes.hpp"
#include "emulator/board/riot.hpp"
#include "emulator/tia/registers/motion.hpp"
#include "emulator/tia/registers/registers.hpp"

namespace racebeam {
namespace {

// Drawing registers with other effects than on the picture, or on other registers.
constexpr std::uint64_t kSpecialRegisters = register_bit(VBLANK) | register_bit(HMCLR);

std::size_t ram_beside_state(const Scheme& scheme) {
  return scheme.ram_bytes > kRamInState ? scheme.ram_bytes : 0;
}

constexpr std::uint8_t kNop = 0xEA;
constexpr unsigned kFirstButton = 12;  // INPT4 among the registers that are read
constexpr unsigned kRiot = 0x80;       // the address bit that selects the RIOT
constexpr unsigned kRamBits = 0x1280, kMirrorBit = 0x0800;
constexpr int kLineLimit = 290, kLineLimitPal = 342;
constexpr std::uint64_t kHash = 0x9E3779B97F4A7C15;
constexpr std::int32_t kNever = std::numeric_limits<std::int32_t>::min() / 4;

}  // namespace

Board::Board(std::shared_ptr<const Rom> rom, const Properties& properties)
    : BoardMemory(*rom, scheme_of(*rom, properties.scheme)),
      video{properties.ystart, properties.height, properties.hmove_blanks, false},
      tia(state.tia, state.frame, video),
      cartridge_ram(ram_beside_state(slot.scheme)),
      ram_select_bits(slot.scheme.watches(Scheme::Watch::kMirrors) ? kRamBits | kMirrorBit : kRamBits),
      rom_(std::move(rom)),
      ports_(properties),
      unwatched_(slot.scheme.watches(Scheme::Watch::kRiot) ? 0 : kRiot) {
  slot.ram = cartridge_ram.empty() ? std::span(state.cartridge.ram).first(slot.scheme.ram_bytes)
                                   : std::span(cartridge_ram);
  if (slot.scheme.power_on != nullptr) slot.scheme.power_on(slot);
  map_memory();
}

// RAM is visible wherever bits 12, 9 and 7 select it. The cartridge maps its own pages.
void Board::map_memory() {
  for (std::size_t page = 0; page < map.page.size(); ++page) {
    const std::size_t address = page * MemoryMap::kPageSize;
    map.page[page] =
        (address & ram_select_bits) == kRiot ? state.riot.ram.data() + (address & 0x40) : nullptr;
  }
  slot.scheme.map(slot);
  code = {};
  known_windows_.fill({});
  tia.rebuild();
  set_format_limits();
}

// The memory map depends only on the cartridge's banks. So it is rebuilt only if they differ.
void Board::restore(const State& other) {
  const bool same_banks = state.cartridge.bank == other.cartridge.bank;
  state = other;
  if (!same_banks) {
    slot.scheme.map(slot);
    code = {};
  }
  tia.rebuild();
  set_format_limits();
}

void Board::set_format_limits() {
  const int limit = video.pal ? kLineLimitPal : kLineLimit;
  overlong_cycle_ = state.tia.origin / 3 + kLineCycles * (limit + 1);
}

std::uint64_t Board::plain_registers() const {
  return slot.scheme.watches(Scheme::Watch::kTia) ? 0 : kPictureRegisters & ~kSpecialRegisters;
}

void Board::open_frame() {
  const std::int32_t phase = (3 * state.cycle - state.tia.origin) % kLineClocks;
  turn_back_clocks(state.cycle);
  state.tia.origin = -phase;
  tia.begin_frame();
  set_format_limits();
}

// Subtracts `cycles` from all clocks that count from the frame's start, except its origin.
void Board::turn_back_clocks(std::int32_t cycles) {
  const auto passed = static_cast<std::uint32_t>(cycles);
  state.riot.timer_set -= passed;
  state.riot.late_read -= passed;
  state.frame.dump_release -= passed;
  state.frame.vsync_finish -= 3 * passed;
  state.frame.cartridge_clock -= passed;
  state.tia.hmove_clock -= 3 * passed;
  state.cycle -= cycles;
}

void Board::begin_step(FrameBuffer& picture, const FrameBuffer* other, WriteLog& scratch, RenderMode mode,
                       Collisions sought) {
  log = &scratch;
  log->begin(state.cycle);
  last_access = kNever;
  exact_mode_ = mode == RenderMode::kExact;
  fetched_latches_ = false;
  plain_registers_ = exact_mode_ ? 0 : plain_registers();
  set_pins();
  tia.begin_step(picture, other, scratch, mode, sought);
}

// Ends the step. A write that repeats what a register holds is not in the log, but it ends a span of drawing,
// up to 5 clocks ahead (docs/spec/tia.md, 4). That is visible if the picture stops inside the window. An
// access that closes the frame is at least 9 clocks later.
void Board::end_step() {
  const bool closed = !state.frame.open && last_access == state.cycle;
  if (closed && !exact_mode_) {
    picture_is_exact_ = tia.end_picture(last_access);
  } else {
    tia.catch_up(last_access);
    picture_is_exact_ = exact_mode_ || !tia.stopped_inside(state.cycle);
  }
}

void Board::record_step(RecordedStep& step, const TiaState& start, std::int32_t lines) const {
  step.start = start;
  step.lines = lines;
  step.base = log->base;
  step.last_access = last_access;
  step.closed = !state.frame.open && last_access == state.cycle;
  step.writes.assign(log->entry.data(), log->next);
}

// The state that returns after a step was replayed, even if memory ran out meanwhile.
class Board::PresentState {
 public:
  explicit PresentState(Board& board)
      : board_(board), tia_(board.state.tia), lines_(board.state.frame.lines) {}
  ~PresentState() {
    board_.state.tia = tia_;
    board_.state.frame.lines = lines_;
    board_.tia.rebuild();
  }
  PresentState(const PresentState&) = delete;
  PresentState& operator=(const PresentState&) = delete;

 private:
  Board& board_;
  const TiaState tia_;
  const std::int32_t lines_;
};

Collisions Board::replay(const RecordedStep& step, FrameBuffer& picture, const FrameBuffer* other,
                         RenderMode mode) {
  thread_local WriteLog replayed;
  const PresentState present(*this);
  state.tia = step.start;
  state.frame.lines = step.lines;
  tia.rebuild();
  replayed.rewind(step.base);
  tia.begin_step(picture, other, replayed, mode, kAllPairs);
  replayed.next = std::ranges::copy(step.writes, replayed.entry.data()).out;
  if (step.closed)
    tia.end_picture(step.last_access);
  else
    tia.catch_up(step.last_access);
  return state.tia.collisions;
}

bool Board::needs_exact_step() const {
  const bool untouched = last_access == kNever && log->size() == 0;
  return !exact_mode_ && (fetched_latches_ || (!untouched && !picture_is_exact_));
}

// What the map shows depends only on the banks. Windows are therefore cached by the banks, and by the 1K
// slice of the address: most slices have one window.
bool Board::find_code(std::uint16_t pc) {
  const std::uint64_t banks = selected_banks();
  const unsigned slice = pc >> 10;
  const auto distance = [pc](const KnownWindow& window) {
    return static_cast<std::uint16_t>(pc - window.first);
  };
  KnownWindow& known = known_windows_[((banks * kHash + slice) * kHash >> 56) % known_windows_.size()];
  if (known.slice != slice || known.banks != banks || distance(known) >= known.span + 2) {
    if (!map.may_hold_code(pc)) return false;
    const CodeWindow window = map.window_around(pc);
    known = {banks, window.memory, window.first, window.span, slice};
  }
  if (distance(known) >= known.span) return false;
  code = {known.memory, known.first, known.span};
  return true;
}

const std::uint8_t* Board::locate_code(std::uint16_t pc, std::uint8_t latch, std::int32_t cycle) {
  return find_code(pc) ? code.memory + static_cast<std::uint16_t>(pc - code.first)
                       : fetch_slowly(pc, latch, cycle);
}

// The opcode is read before its cycles are counted, the operand after that (docs/spec/cpu.md, 3).
const std::uint8_t* Board::fetch_slowly(std::uint16_t pc, std::uint8_t latch, std::int32_t cycle) {
  if ((pc & 0x1088) == 0 && !exact_mode_) return give_up_step(pc);
  const std::uint8_t opcode = fetched_[0] = read(pc, latch, cycle);
  latch = opcode;
  for (unsigned i = 1; i < kOpcodes[opcode].length; ++i)
    fetched_[i] = latch = read(static_cast<std::uint16_t>(pc + i), latch, cycle + kOpcodes[opcode].cycles);
  code = {fetched_.data(), pc, 0, nullptr};
  return fetched_.data();
}

// An opcode that was fetched from a collision register depends on what a write in the same cycle drew ahead.
// The step ends before it is executed: what it would draw, the exact step may never reach.
const std::uint8_t* Board::give_up_step(std::uint16_t pc) {
  fetched_latches_ = stop = true;
  fetched_[0] = kNop;
  code = {fetched_.data(), pc, 0, nullptr};
  return fetched_.data();
}

std::uint8_t Board::read(std::uint16_t address, std::uint8_t latch, std::int32_t cycle) {
  const std::uint8_t* page = map.page_of(address);
  return page != nullptr ? page[address & 0x3F] : read_device(address, latch, cycle);
}

// Closes the code window if the access has changed the map, so that the CPU locates its code again.
std::uint8_t Board::read_cartridge(std::uint16_t address, std::int32_t cycle) {
  const std::uint64_t banks = selected_banks();
  const std::uint8_t value = slot.scheme.read(slot, address, cycle);
  if (selected_banks() != banks) code.close();
  return value;
}

Delivery Board::write_cartridge(std::uint16_t address, std::uint8_t value) {
  const std::uint64_t banks = selected_banks();
  const Delivery delivery = slot.scheme.write(slot, address, value);
  if (selected_banks() != banks) code.close();
  return delivery;
}

void Board::observe(const Access& access) {
  const std::uint64_t banks = selected_banks();
  slot.scheme.observe(slot, access);
  if (selected_banks() != banks) code.close();
}

std::uint8_t Board::read_device(std::uint16_t address, std::uint8_t latch, std::int32_t cycle) {
  if (address & 0x1000) return read_cartridge(address, cycle);
  if (address & unwatched_) return read_riot(address, cycle);
  if (slot.scheme.watches(Scheme::Watch::kTia)) [[unlikely]] {
    read_cartridge(address, cycle);
    if (address & kRiot) return read_watched(address, cycle);
  }
  return read_tia(address, latch, cycle);
}

// WSYNC comes first, because most lines have one.
std::int32_t Board::write_device(std::uint16_t address, std::uint8_t value, std::int32_t cycle,
                                 bool after_read) {
  const bool plain = address == WSYNC && cycle < overlong_cycle_ && !slot.scheme.watches(Scheme::Watch::kTia);
  return plain ? write_wsync(cycle, after_read) : write_anywhere(address, value, cycle, after_read);
}

std::int32_t Board::write_anywhere(std::uint16_t address, std::uint8_t value, std::int32_t cycle,
                                   bool after_read) {
  const bool to_cartridge = (address & 0x1000) != 0;
  if (!to_cartridge && (address & unwatched_) != 0) {
    write_riot(address, value, cycle);
    return cycle;
  }
  if (to_cartridge || slot.scheme.watches(Scheme::Watch::kTia)) {
    if (write_cartridge(address, value) == Delivery::kTaken) return cycle;
    if (!to_cartridge && (address & kRiot) != 0) {
      write_watched(address, value, cycle);
      return cycle;
    }
  }
  return write_tia(address, value, cycle, after_read);
}

// The RIOT, also its RAM, behind a cartridge that has seen the access.
std::uint8_t Board::read_watched(std::uint16_t address, std::int32_t cycle) {
  return (address & kRamBits) == kRiot ? state.riot.ram[address & 0x7F] : read_riot(address, cycle);
}

void Board::write_watched(std::uint16_t address, std::uint8_t value, std::int32_t cycle) {
  if ((address & kRamBits) == kRiot)
    state.riot.ram[address & 0x7F] = value;
  else
    write_riot(address, value, cycle);
}

std::uint8_t Board::read_riot(std::uint16_t address, std::int32_t cycle) {
  // clang-format off
  switch (address & 7) {
    case 0: return ports_.swcha(state, cycle);
    case 1: return state.riot.swacnt;
    case 2: return state.inputs.switches;
    case 3: return 0;
    case 4: case 6: return Timer(state.riot, cycle).intim();
    default: return Timer(state.riot, cycle).instat();
  }
  // clang-format on
}

// SWCHA and SWACNT. Only a keyboard notices the levels.
void Board::write_port(unsigned reg, std::uint8_t value) {
  if (reg == 1) state.riot.swacnt = value;
  if (!ports_.has_keyboard()) return;
  if (reg == 0) state.frame.swcha = value;
  set_pins();
}

// The ports come first, and ignore A4 (docs/spec/riot.md, 1).
void Board::write_riot(std::uint16_t address, std::uint8_t value, std::int32_t cycle) {
  if ((address & 7) < 2)
    write_port(address & 7, value);
  else if ((address & 0x14) == 0x14)
    Timer(state.riot, cycle).set(value, kTimerShift[address & 3]);
}

// An access that draws up to its clock, and changes no register.
void Board::touch_tia(std::int32_t cycle) {
  last_access = cycle;
  if (exact_mode_) tia.catch_up(cycle);
}

void Board::make_room(std::int32_t cycle) {
  if (log->is_short_of_room(cycle)) tia.empty_log(cycle);
}

std::uint8_t Board::read_tia(std::uint16_t address, std::uint8_t latch, std::int32_t cycle) {
  const unsigned reg = address & 0x0F;
  std::uint8_t driven = 0;
  if (reg < 8) {
    driven = collision_bits(reg, cycle);
  } else {
    touch_tia(cycle);
    driven = pin(reg - 8, cycle);
    if (has_gun_ && gun_sees_beam(reg - kFirstButton, cycle)) [[unlikely]]
      driven = 0;
  }
  return static_cast<std::uint8_t>(driven | (latch & 0x3F));
}

bool Board::gun_sees_beam(unsigned side, std::int32_t cycle) const {
  if (side > 1) return false;
  return ports_.sees_beam(side, state.inputs, cycle, state.tia.origin / 3 + kLineCycles * video.ystart);
}

// These are the only reads that depend on the picture: the log is played up to `cycle`.
std::uint8_t Board::collision_bits(unsigned reg, std::int32_t cycle) {
  last_access = cycle;
  tia.find_collisions(cycle, static_cast<Collisions>(3U << (2 * reg)));
  return static_cast<std::uint8_t>((state.tia.collisions >> (2 * reg) & 3) << 6);
}

std::int32_t Board::write_tia(std::uint16_t address, std::uint8_t value, std::int32_t cycle,
                              bool after_read) {
  const unsigned reg = address & 0x3F;
  if (cycle >= overlong_cycle_) {
    close_frame();
  }
  switch (reg) {
    case VSYNC: write_vsync(value, cycle); break;
    case VBLANK: write_dump((value & 0x80) != 0, cycle); break;
    default:
      if (is_sound(reg)) sound.write(reg, value);
  }
  if (reg == WSYNC) return write_wsync(cycle, after_read);
  if (!(kPictureRegisters >> reg & 1)) {
    touch_tia(cycle);
    return cycle;
  }
  last_access = cycle;
  make_room(cycle);
  log->append(cycle, reg, value);
  if (exact_mode_) tia.play_log(cycle);
  return cycle;
}

// The CPU stops until the next line starts, if its next access is a read.
std::int32_t Board::write_wsync(std::int32_t cycle, bool after_read) {
  touch_tia(cycle);
  make_room(cycle);
  if (!after_read) return cycle;
  const std::int32_t into = (cycle - state.tia.origin / 3) % kLineCycles;
  return into == 0 ? cycle : cycle + kLineCycles - into;
}

void Board::write_vsync(std::uint8_t value, std::int32_t cycle) {
  FrameState& frame = state.frame;
  const auto clock = 3 * static_cast<std::uint32_t>(cycle);
  if (value & 2) {
    frame.vsync_finish = clock + kLineClocks;
  } else if (static_cast<std::int32_t>(clock) >= static_cast<std::int32_t>(frame.vsync_finish)) {
    frame.vsync_finish = 0x7FFFFFFF;
    close_frame();
  }
}

void Board::close_frame() {
  state.frame.open = 0;
  stop = true;
  code.close();
}

void Board::write_dump(bool on, std::int32_t cycle) {
  FrameState& frame = state.frame;
  if (static_cast<bool>(frame.dumping) == on) return;
  if (!on) frame.dump_release = static_cast<std::uint32_t>(cycle);
  frame.dumping = on;
  set_pins();
}

// The inputs are the same in the whole step.
void Board::set_pins() {
  pin_high_from.fill(Ports::kNever);
  for (unsigned pin = 0; pin < Ports::kPins; ++pin) pin_high_from[pin] = ports_.high_from(pin, state);
}

}  // namespace racebeam
