#include "emulator/translator/x86_64/assembler.hpp"

namespace racebeam::translator::x86_64 {

void Assembler::L(Label& label) {
  Target& target = targets_[label];
  target.place = static_cast<std::int64_t>(getSize());
  for (std::int32_t jump = target.jumps; jump >= 0; jump = jumps_[static_cast<std::size_t>(jump)].next) {
    const Jump& each = jumps_[static_cast<std::size_t>(jump)];
    resolve(each.end, each.is_short, target.place);
  }
}

// A jump back is short if a byte can hold the distance.
void Assembler::jump(const Opcodes& opcodes, Label& to, LabelType type) {
  constexpr std::int64_t kShortSize = 2, kFarthestBack = 128;
  Target& target = targets_[to];
  const bool is_known = target.place >= 0;
  const auto here = static_cast<std::int64_t>(getSize());
  const bool is_short = type != T_NEAR && (!is_known || here + kShortSize - target.place <= kFarthestBack);
  write_jump(opcodes, is_short);
  if (is_known) return resolve(getSize(), is_short, target.place);
  jumps_.push_back({getSize(), target.jumps, is_short});
  target.jumps = static_cast<std::int32_t>(jumps_.size()) - 1;
}

void Assembler::write_jump(const Opcodes& opcodes, bool is_short) {
  if (is_short) {
    db(opcodes.with_byte);
    return db(0);
  }
  if (opcodes.has_prefix) db(0x0F);
  db(opcodes.with_dword);
  dd(0);
}

// Writes the displacement of a jump.
void Assembler::resolve(std::size_t end, bool is_short, std::int64_t place) {
  const std::int64_t distance = place - static_cast<std::int64_t>(end);
  if (is_short && distance != static_cast<std::int8_t>(distance))
    throw AssemblyError(Xbyak::ERR_LABEL_IS_TOO_FAR);
  const std::size_t size = is_short ? 1 : 4;
  rewrite(end - size, static_cast<std::uint64_t>(distance), size);
}

}  // namespace racebeam::translator::x86_64
