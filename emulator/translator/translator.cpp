#include "emulator/translator/translator.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <system_error>

#include "emulator/board/board.hpp"
#include "emulator/cpu/cpu.hpp"
#include "emulator/translator/block_discovery.hpp"
#include "emulator/translator/image_code.hpp"
#include "emulator/translator/translation_budget.hpp"

namespace racebeam {
namespace {

// No block lasts longer, so that a write in it comes before the line limit if the block starts before it by this much.
constexpr std::int32_t kMargin = 400;

constexpr std::int32_t kFewestCycles = 2;  // of an instruction

// Rows of instructions that are interpreted: short ones end exactly, others at a jump or branch, after so many more at most.
constexpr std::int32_t kShortRow = 32, kMostRow = 4096;

// Where a step is longer than what translated code may run, it is run again by the interpreter. After such a step others
// are left to it at once: one, then three, up to 63; fewer again after many that were not so long.
class Retreat {
 public:
  bool goes_on() { return left_ > 0 && left_-- > 0; }
  void note(bool whole) {
    if (whole) {
      if (++calm_ % kCalm == 0) length_ /= 2;
      return;
    }
    calm_ = 0;
    left_ = length_ = std::min(2 * length_ + 1, kLongest);
  }

 private:
  static constexpr int kLongest = 63, kCalm = 64;

  int length_ = 0, left_ = 0, calm_ = 0;  // steps
};

// How many instructions the interpreter runs before translated code is looked for again. Where there is none that pays, it
// runs twice as many each time: looking costs as much as interpreting a few.
class Row {
 public:
  std::int32_t next(std::int32_t least) {
    const std::int32_t length = std::max(length_, least);
    length_ = std::min(2 * length_, kLongest);
    return length;
  }
  void end() { length_ = 1; }

 private:
  static constexpr std::int32_t kLongest = 128;

  std::int32_t length_ = 1;
};

bool same(const CodeWindow& a, const CodeWindow& b) {
  return a.memory == b.memory && a.first == b.first && a.span == b.span;
}

void unpack_status(translator::Context& context, std::uint8_t p) {
  context.nz = (p & 0x80U) << 8 | (p & 2 ? 0U : 1U);
  context.carry = p & 1;
  context.V = p >> 6 & 1;
  context.D = p >> 3 & 1;
  context.I = p >> 2 & 1;
}

std::uint8_t pack_status(const translator::Context& context) {
  const unsigned n = context.nz & 0x8080 ? 0x80U : 0U, z = context.nz & 0xFF ? 0U : 2U;
  const unsigned others = unsigned{context.V} << 6 | unsigned{context.D} << 3 | unsigned{context.I} << 2;
  return static_cast<std::uint8_t>(n | others | z | context.carry);
}

// Whether the system lets memory be made executable is found out once.
const std::string& refusal() {
  static const std::string reason = [] {
    try {
      translator::CodeMemory(1).seal(1);
      return std::string();
    } catch (const std::system_error& error) {
      return std::string(error.what());
    }
  }();
  return reason;
}

}  // namespace

struct Translator::Impl {
  Impl(Board& board, bool always) : layout(board), purse(always) {}

  // Windows that were looked into before, by their place: a bank switch finds its way back without asking the image.
  struct Seen {
    CodeWindow window;
    translator::View* view = nullptr;
  };

  // Where the instruction at PC is translated: `start` is null if it is not.
  struct Block {
    const void* start = nullptr;
    translator::Worth* worth = nullptr;
  };

  bool has_code(Board& board);
  translator::View* current_view(Board& board);
  Block block(Board& board);
  bool enter(Board& board, const void* start);
  std::int32_t run_block(Board& board, const Block& block);

  std::shared_ptr<translator::ImageCode> code;  // null until some can be afforded
  const translator::Layout layout;
  std::array<Seen, 32> seen{};
  translator::Purse purse;
  Row row;
  Retreat retreat;
};

// False as long as there is none. A new generation is begun when the old one is full.
bool Translator::Impl::has_code(Board& board) {
  const bool is_useful = code != nullptr && !code->is_full();
  if (is_useful || !purse.affords_batch()) return code != nullptr;
  const translator::Purse::Payment payment(purse);
  try {
    code = translator::ImageCode::of(board.slot.rom, {board.plain_registers(), board.slot.scheme.port_reader});
    seen = {};
  } catch (const std::system_error&) {
    // There is no memory for code now: it is tried again at a later step.
  }
  return code != nullptr;
}

translator::View* Translator::Impl::current_view(Board& board) {
  const std::uint16_t pc = board.state.cpu.PC;
  if (static_cast<std::uint16_t>(pc - board.code.first) >= board.code.span && !board.find_code(pc)) return nullptr;
  const std::uintptr_t place = reinterpret_cast<std::uintptr_t>(board.code.memory) / MemoryMap::kPageSize;
  Seen& known = seen[(place ^ board.code.first / 1024U) % seen.size()];
  if (known.view == nullptr || !same(known.window, board.code)) {
    const translator::Purse::Payment payment(purse);
    known = {board.code, code->view(board.code, board.slot.rom, purse.affords_batch())};
  }
  return known.view;
}

// The block at PC, made if it can be afforded.
Translator::Impl::Block Translator::Impl::block(Board& board) {
  translator::View* view = current_view(board);
  if (view == nullptr) return {};
  const std::uint16_t pc = board.state.cpu.PC;
  if (!translator::holds(view->code, pc)) return {};
  translator::Worth* const worth = &view->worth[static_cast<std::uint16_t>(pc - view->code.first)];
  if (const void* known = view->entry(pc)) return {known, worth};
  if (code->is_full() || !purse.affords_batch()) return {};
  const translator::Purse::Payment payment(purse);
  return {code->translate(*view, pc, layout), worth};
}

// True if the interpreter must do the next instruction.
bool Translator::Impl::enter(Board& board, const void* entry) {
  translator::Context& context = board.translated;
  unpack_status(context, board.state.cpu.P);
  const std::uint32_t left = code->enter()(entry, &board, board.log);
  board.state.cpu.PC = static_cast<std::uint16_t>(left);
  board.state.cpu.P = pack_status(context);
  return (left & translator::kInterpretNext) != 0;
}

// Runs translated code from `block` on. Returns how many instructions the interpreter must do then.
std::int32_t Translator::Impl::run_block(Board& board, const Block& block) {
  if (!purse.is_endless() && block.worth->is_poor()) return row.next(block.worth->length());
  const std::int32_t before = board.state.cycle - board.translated.waited;
  const bool interpret_next = enter(board, block.start);
  const std::int32_t cycles = board.state.cycle - board.translated.waited - before;
  if (!board.stop) block.worth->note(cycles);
  if (cycles >= translator::Worth::kFewestCycles) row.end();
  return interpret_next ? 1 : 0;
}

Translator::Translator(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Translator::~Translator() = default;

std::unique_ptr<Translator> Translator::make(Board& board, CpuKind kind) {
  if (kind == CpuKind::kInterpreter) return nullptr;
  if (!refusal().empty()) {
    if (kind == CpuKind::kAuto) return nullptr;
    throw std::system_error(std::make_error_code(std::errc::permission_denied), refusal());
  }
  return std::unique_ptr<Translator>(new Translator(std::make_unique<Impl>(board, kind == CpuKind::kTranslator)));
}

bool Translator::run(Board& board, std::int32_t instructions) {
  impl_->purse.begin_step();
  if (impl_->retreat.goes_on() || !impl_->has_code(board)) {
    interpret(board, instructions);
    return true;
  }
  const bool begins_frame = board.state.cycle < board.overlong_cycle() - kMargin;
  const bool whole = run_blocks(board, instructions);
  if (begins_frame) impl_->retreat.note(whole);
  return whole;
}

bool Translator::run_blocks(Board& board, std::int32_t instructions) {
  board.stop = false;
  const std::int32_t first_cycle = board.state.cycle;
  const std::int32_t limit = board.translated.limit = board.overlong_cycle() - kMargin;
  board.translated.first_line = board.state.tia.origin / 3;
  while (!board.stop && !board.state.cpu.jammed) {
    const std::int32_t left = instructions - (board.state.cycle - first_cycle) / kFewestCycles;
    if (board.state.cycle >= limit || left <= 0) {
      interpret(board, left);
      return board.stop || board.state.cpu.jammed || first_cycle >= limit;
    }
    const Impl::Block block = impl_->block(board);
    const std::int32_t row = block.start != nullptr ? impl_->run_block(board, block) : impl_->row.next(1);
    if (row == 0 || board.stop) continue;
    if (row < kShortRow || left < row + kMostRow) interpret(board, std::min(row, left));
    else interpret(board, row + kMostRow, row);
  }
  return true;
}

void Translator::end_step() { impl_->purse.end_step(); }

void Translator::set_code_capacity(std::size_t bytes) { translator::set_code_capacity(bytes); }

const char* Translator::obstacle() { return refusal().c_str(); }

}  // namespace racebeam
