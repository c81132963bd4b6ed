#include "emulator/translator/translator.hpp"

#include "emulator/board.hpp"
#include "emulator/cpu.hpp"
#include "emulator/translator/program.hpp"

namespace racebeam::translator {
namespace {

// No block lasts longer, so that a write in it comes before the line limit if the block starts before it by this much.
constexpr std::int32_t kMargin = 400;

// Instructions that the interpreter runs at a time where there is nothing to translate: code in RAM, mostly.
constexpr std::int32_t kElsewhere = 4;

constexpr std::int32_t kFewestCycles = 2;  // of an instruction

bool same(const CodeWindow& a, const CodeWindow& b) {
  return a.memory == b.memory && a.first == b.first && a.span == b.span;
}

void unpack_status(Context& context, std::uint8_t p) {
  context.nz = (p & 0x80U) << 8 | (p & 2 ? 0U : 1U);
  context.carry = p & 1;
  context.V = p >> 6 & 1;
  context.D = p >> 3 & 1;
  context.I = p >> 2 & 1;
}

std::uint8_t pack_status(const Context& context) {
  const unsigned n = context.nz & 0x8080 ? 0x80U : 0U, z = context.nz & 0xFF ? 0U : 2U;
  return static_cast<std::uint8_t>(n | unsigned{context.V} << 6 | unsigned{context.D} << 3 | unsigned{context.I} << 2 | z |
                                   context.carry);
}

}  // namespace

Translator::Translator(Board& board)
    : code_(ImageCode::of(board.slot.rom)), layout_(board), plain_registers_(board.plain_registers()) {}

View* Translator::current_view(Board& board) {
  if (board.code.span == 0 || static_cast<std::uint16_t>(board.state.cpu.PC - board.code.first) >= board.code.span) {
    if (!board.find_code(board.state.cpu.PC)) return nullptr;
  }
  if (current_.view != nullptr && same(current_.window, board.code)) return current_.view;
  for (const Seen& seen : seen_) {
    if (seen.view == nullptr || !same(seen.window, board.code)) continue;
    current_ = seen;
    return current_.view;
  }
  current_ = {board.code, code_->view(board.code, board.slot.rom)};
  if (current_.view != nullptr) seen_[next_seen_++ % seen_.size()] = current_;
  return current_.view;
}

const void* Translator::entry(Board& board) {
  View* view = current_view(board);
  if (view == nullptr) return nullptr;
  if (const void* known = view->entry(board.state.cpu.PC)) return known;
  if (!holds(view->code, board.state.cpu.PC) || code_->is_full()) return nullptr;
  return code_->translate(*view, board.state.cpu.PC, layout_, plain_registers_);
}

// True if the interpreter must do the next instruction.
bool Translator::enter(Board& board, const void* entry) {
  Context& context = board.translated;
  unpack_status(context, board.state.cpu.P);
  const std::uint32_t left = code_->enter()(entry, &board, board.log);
  board.state.cpu.PC = static_cast<std::uint16_t>(left);
  board.state.cpu.P = pack_status(context);
  return (left & kInterpretNext) != 0;
}

bool Translator::run(Board& board, std::int32_t instructions) {
  if (code_->is_full()) *this = Translator(board);
  board.stop = false;
  board.translated.limit = board.overlong_cycle() - kMargin;
  board.translated.first_line = board.state.tia.origin / 3;
  const std::int32_t first_cycle = board.state.cycle;
  while (!board.stop && !board.state.cpu.jammed) {
    if (board.state.cycle >= board.translated.limit) {
      interpret(board, instructions - (board.state.cycle - first_cycle) / kFewestCycles);
      return board.stop || board.state.cpu.jammed || first_cycle >= board.translated.limit;
    }
    const void* start = entry(board);
    if (start != nullptr && !enter(board, start)) continue;
    if (!board.stop) interpret(board, start != nullptr ? 1 : kElsewhere);
  }
  return true;
}

}  // namespace racebeam::translator
