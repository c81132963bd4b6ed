#include "emulator/tia/line_cache/line_record.hpp"

#include "emulator/tia/line/objects.hpp"
#include "emulator/tia/registers/motion.hpp"
#include "emulator/tia/registers/register_bytes.hpp"
#include "emulator/tia/registers/registers.hpp"
#include "emulator/tia/registers/write_log.hpp"

namespace racebeam {
namespace {

// A write that comes no later than this after RESPx may wait for the old copy of the player.
constexpr std::uint32_t kWaitOfRespx = TiaWrite(4, 0, 0).packed() - 1;

// Bytes that a line may change without a write, and what that depends on. The end of a line latches REFLECT,
// and lets players be shown again. Missile 0 moves in its Cosmic Ark mode.
constexpr ByteSet kAlways = RACEBEAM_TIA_BYTE_SET((ctrlpf, reflect, enabled, cosmic, p0.skip, p1.skip));
constexpr ByteSet kUsedUp = RACEBEAM_TIA_BYTE_SET((comb_armed));  // by a line that uses them
constexpr ByteSet kMotions = set_of(kRegisterBytes[HMCLR].sets);
constexpr ByteSet kColubkByte = RACEBEAM_TIA_BYTE_SET((color[3]));
constexpr ByteSet kForeseen = RACEBEAM_TIA_BYTE_SET((spare[0]));

// What a write sets and may set, by register. HMOVE sets the positions that it moves.
struct WrittenBytes {
  ByteSet sets, may_set;
};
constexpr auto kWrittenBytes = [] {
  std::array<WrittenBytes, 64> table{};
  for (unsigned reg = 0; reg < table.size(); ++reg)
    table[reg] = {set_of(kRegisterBytes[reg].sets), reg == HMOVE ? 0 : set_of(kRegisterBytes[reg].may_set)};
  return table;
}();

constexpr std::array<ByteSet, 5> kPositions = {  // by Object
    RACEBEAM_TIA_BYTE_SET((p0.position)), RACEBEAM_TIA_BYTE_SET((p1.position)),
    RACEBEAM_TIA_BYTE_SET((m0.position)), RACEBEAM_TIA_BYTE_SET((m1.position)),
    RACEBEAM_TIA_BYTE_SET((ball.position))};

void clear_but(TiaRegisters& registers, const TiaRegisters& mask) {
  RegisterVectors bytes(registers);
  bytes &= RegisterVectors(mask);
  bytes.write(registers);
}

// The motions as far as they affect positions, by Object. HMP0 to HMBL are in that order, too.
std::array<std::uint8_t, 5> motions_of(const TiaRegisters& tia) {
  return {tia.player[0].motion, tia.player[1].motion, tia.missile[0].motion, tia.missile[1].motion,
          tia.ball.motion};
}

// The positions that an HMOVE in this cycle changes.
ByteSet moved_positions(int cycle, const std::array<std::uint8_t, 5>& motion) {
  const auto& movement = kMovement[static_cast<std::size_t>(cycle + kLineCycles) % kLineCycles];
  ByteSet moved = 0;
  for (std::size_t object = 0; object < motion.size(); ++object)
    if (movement[motion[object]] != 0) moved |= kPositions[object];
  return moved;
}

// Returns `seen` without an object that cannot be told from the background: the only object of the line, in
// its colour. It meets nothing, so that its shape does not count. The colours do. The line is therefore
// marked as one with a playfield of these colours: COLUPF or, in score mode, the players'. tia: at the end of
// the line.
std::uint16_t without_hidden_object(unsigned seen, const TiaRegisters& tia) {
  static constexpr std::array<std::uint8_t, kObjects> kColor = {0, 1, 0, 1, 2, 2};
  const unsigned objects = seen & kAllObjects;
  if (objects != 0 && (objects & (objects - 1)) == 0 && (seen & kRecolors) == 0) {
    const std::uint8_t color = kColor[static_cast<std::size_t>(std::countr_zero(objects))];
    if (tia.color[color] == tia.color[3])
      seen = (seen ^ objects) | (color == 2 ? object_bit(kPlayfield) : kScoreSeen);
  }
  return static_cast<std::uint16_t>(seen);
}

}  // namespace

void LineRecord::open(const TiaRegisters& registers) {
  number = kNoLine;  // until the line is complete
  start = registers;
  mask = &LineMask::kWhole;
  view = {};
  count = 0;
  repeats = false;
}

const std::uint32_t* LineRecord::add(const std::uint32_t* entry, std::uint32_t origin) {
  assert(state() == LineState::kOpen);
  unsigned dependencies = 0, control = 0, events = count;
  for (; events < kMaxEvents; ++entry) {
    const LineWrite write(*entry, origin);
    if (!write.acts_here()) break;
    event[events++] = write.packed();
    const LineEffect& effect = kLineEffects[write.reg()];
    dependencies |= effect.seen;
    const bool waits_for_nobody = (write.reg() & ~1U) == RESP0 && entry[1] - *entry > kWaitOfRespx;
    if (!waits_for_nobody) control |= effect.control;
  }
  count = static_cast<std::uint8_t>(events);
  view.seen = static_cast<std::uint16_t>(view.seen | dependencies);
  view.control = static_cast<std::uint8_t>(view.control | control);
  return entry;
}

void LineRecord::close(const TiaState& tia, std::int32_t first_clock) {
  view.seen = without_hidden_object(view.seen, tia);
  end = tia;
  hmove_clock = static_cast<std::int16_t>(tia.hmove_clock - static_cast<std::uint32_t>(first_clock));
  set_foreseen((start.cosmic | tia.cosmic) == 0 && (view.seen & kMayBeCosmic) == 0);
}

std::uint8_t LineRecord::hash() const {
  assert(state() != LineState::kSummarized);
  constexpr std::uint64_t kOdd = 0x9E3779B97F4A7C15;
  RegisterVectors bytes(start);
  bytes &= seen_bytes();
  std::uint64_t hash = count;
  for (const TwoWords part : bytes.part)
    for (const std::uint64_t word : {part[0], part[1]}) hash = std::rotl((hash ^ word) * kOdd, 29);
  for (unsigned i = 0; i < count; ++i) hash = std::rotl((hash ^ event[i]) * kOdd, 29);
  return static_cast<std::uint8_t>(hash >> 56);
}

// Computes which bytes count, and which are known at the end. A register's value at the end depends on the
// writes, on the bytes that count for what is shown (line_dependencies.hpp), and on the following.
void LineRecord::summarize(bool pal) {
  assert(state() == LineState::kDrawn);
  ByteSet counts = kAlways, sets = kUsedUp;
  std::array<std::uint8_t, 5> motion = motions_of(start);
  bool foreseen = (start.cosmic | end.cosmic) == 0;
  for (unsigned i = 0; i < count; ++i) {
    const LineWrite write(event[i]);
    const unsigned reg = write.reg();
    sets |= kWrittenBytes[reg].sets;
    counts |= kWrittenBytes[reg].may_set;  // or they stay as they were
    // clang-format off
    switch (reg) {
      // HMM0 may start the Cosmic Ark mode, by an HMOVE on the previous line.
      case HMM0: foreseen &= write.value() >> 4 != 6; [[fallthrough]];
      case HMP0: case HMP1: case HMM1: case HMBL: motion[reg - HMP0] = write.value() >> 4; break;
      case HMCLR: motion = {}; break;
      case HMOVE:
        counts |= moved_positions(write.cycle(), motion);
        break;
      // In PAL, all colours have the frame's colour loss in bit 0.
      case COLUP0: case COLUP1: case COLUPF: case COLUBK:
        if (pal) counts |= kColubkByte;
        break;
      default: break;
    }
    // clang-format on
  }
  counts |= seen_bytes().bytes_set();  // and CTRLPF, whose bits seldom all count, by kAlways
  if (view.seen & kMoves) counts |= kMotions;
  if (!foreseen) counts |= kForeseen;
  sets |= counts;
  const LineMask* const found = LineMask::find(counts, sets);
  if (found == nullptr) return;
  mask = found;
  clear_but(start, mask->counts);
  clear_but(end, mask->sets);
  set_foreseen(foreseen);
}

bool LineRecord::is_repetition_of(const LineRecord& before) const {
  if (mask != before.mask || (count | before.count) != 0 || meetings != before.meetings) return false;
  const RegisterVectors begin(start);
  RegisterVectors end_counts(end);
  end_counts &= RegisterVectors(mask->counts);
  return (begin.bytes_other_than(RegisterVectors(before.start)) | begin.bytes_other_than(end_counts)) == 0;
}

}  // namespace racebeam
