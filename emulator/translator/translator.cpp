#include "emulator/translator/translator.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <optional>
#include <string>
#include <system_error>

#include "emulator/board.hpp"
#include "emulator/cpu.hpp"
#include "emulator/translator/budget.hpp"
#include "emulator/translator/image_code.hpp"
#include "emulator/translator/program.hpp"

namespace racebeam {
namespace {

// No block lasts longer, so that a write in it comes before the line limit if the block starts before it by
// this much.
constexpr std::int32_t kMargin = 400;

// Instructions that the interpreter runs at a time where there is nothing to translate: code in RAM, mostly.
constexpr std::int32_t kElsewhere = 8;

// Translated code that has worked for so many cycles since the interpreter ran last was worth the way there.
// Where it was not, the interpreter runs twice as long the next time.
constexpr std::int32_t kWorthwhile = 40;
constexpr std::int32_t kLongestStretch = 32;  // instructions

constexpr std::int32_t kFewestCycles = 2;  // of an instruction

std::atomic<bool> boundless = false;

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
  explicit Impl(Board& board)
      : wiring{board.plain_registers(), board.slot.scheme.port_reader}, layout(board) {}

  // Windows that were looked into before, by their place: a bank switch finds its way back without asking the
  // image.
  struct Seen {
    CodeWindow window;
    translator::View* view = nullptr;
  };

  struct Way {
    const void* entry = nullptr;  // of the block at PC; null if there is none
    bool waits = false;           // there will be one, when it can be paid
  };

  bool may_translate(const Board& board);
  bool run(Board& board, std::int32_t instructions);
  void run_interpreted(Board& board, std::int32_t instructions);
  void run_stretch(Board& board, bool left);
  translator::View* current_view(Board& board);
  Way find_way(Board& board);
  bool enter(Board& board, const void* entry);

  const translator::Wiring wiring;
  const translator::Layout layout;
  translator::Budget budget = boundless ? translator::Budget::boundless() : translator::Budget{};
  std::shared_ptr<translator::ImageCode> code;  // null before there is a budget for it
  std::array<Seen, 32> seen{};
  translator::Work work;        // of the step
  translator::Cost gained = 0;  // cycles of work in translated code since the interpreter ran last
  std::int32_t stretch = 1;     // instructions that it runs the next time
};

// Is there code, and a budget to go to and fro? A generation of code that is full is left.
bool Translator::Impl::may_translate(const Board& board) {
  if (code && code->is_full()) {
    code.reset();
    seen.fill({});
  }
  if (!code && budget.making.can_pay(translator::kImagePrice)) {
    budget.making.spend(translator::kImagePrice);
    try {
      code = translator::ImageCode::of(board.slot.rom, wiring, layout);
    } catch (const std::system_error&) {  // no memory: perhaps later
    }
  }
  return code != nullptr && budget.moving.can_pay(translator::Budget::kEnoughToMove);
}

translator::View* Translator::Impl::current_view(Board& board) {
  const std::uint16_t pc = board.state.cpu.PC;
  if (static_cast<std::uint16_t>(pc - board.code.first) >= board.code.span && !board.find_code(pc))
    return nullptr;
  const std::uintptr_t place = reinterpret_cast<std::uintptr_t>(board.code.memory) / MemoryMap::kPageSize;
  Seen& known = seen[(place ^ board.code.first / 1024U) % seen.size()];
  if (known.view == nullptr || !same(known.window, board.code)) {
    budget.moving.spend(translator::kWindowPrice);
    known = {board.code, code->view(board.code, board.slot.rom, budget.making)};
  }
  return known.view;
}

// The block at PC, made if need be.
Translator::Impl::Way Translator::Impl::find_way(Board& board) {
  translator::View* view = current_view(board);
  if (view == nullptr || !translator::holds(view->code, board.state.cpu.PC)) return {};
  const void* entry = view->entry(board.state.cpu.PC);
  if (entry == nullptr && !budget.making.is_empty())
    entry = code->translate(*view, board.state.cpu.PC, budget.making);
  return {entry, entry == nullptr};
}

// True if the interpreter must do the next instruction.
bool Translator::Impl::enter(Board& board, const void* entry) {
  translator::Context& context = board.translated;
  unpack_status(context, board.state.cpu.P);
  context.idle = context.calls = 0;
  const std::int32_t before = board.state.cycle;
  const std::uint32_t left = code->enter()(entry, &board, board.log);
  board.state.cpu.PC = static_cast<std::uint16_t>(left);
  board.state.cpu.P = pack_status(context);
  const translator::Work done{0, board.state.cycle - before - context.idle, context.calls};
  work.translated += done.translated;
  work.calls += done.calls;
  gained += done.translated;
  budget.move(done.quick());
  return (left & translator::kInterpretNext) != 0;
}

void Translator::Impl::run_interpreted(Board& board, std::int32_t instructions) {
  board.translated.skipped = 0;
  work.interpreted += interpret(board, instructions) - board.translated.skipped;
}

// What translated code did not do, if it was any that was left.
void Translator::Impl::run_stretch(Board& board, bool left) {
  if (gained < kWorthwhile)
    stretch = std::min(2 * stretch, kLongestStretch);
  else
    stretch = left ? 1 : kElsewhere;
  gained = 0;
  budget.moving.spend(translator::kStretchPrice + stretch * translator::kCountingPrice);
  run_interpreted(board, stretch);
}

bool Translator::Impl::run(Board& board, std::int32_t instructions) {
  board.stop = false;
  const std::int32_t limit = board.translated.limit = board.overlong_cycle() - kMargin;
  board.translated.first_line = board.state.tia.origin / 3;
  const std::int32_t first_cycle = board.state.cycle;
  while (board.state.cycle < limit && !budget.moving.is_empty()) {
    const Way way = find_way(board);
    if (way.waits) break;
    const bool leaves = way.entry == nullptr || enter(board, way.entry);
    if (leaves && !board.stop) run_stretch(board, way.entry);
    if (board.stop || board.state.cpu.jammed) return true;
  }
  run_interpreted(board, instructions - (board.state.cycle - first_cycle) / kFewestCycles);
  return board.stop || board.state.cpu.jammed || first_cycle >= limit;
}

Translator::Translator(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Translator::~Translator() = default;

std::unique_ptr<Translator> Translator::make(Board& board, CpuKind kind) {
  if (kind == CpuKind::kInterpreter) return nullptr;
  if (!refusal().empty()) {
    if (kind == CpuKind::kAuto) return nullptr;
    throw std::system_error(std::make_error_code(std::errc::permission_denied), refusal());
  }
  return std::unique_ptr<Translator>(new Translator(std::make_unique<Impl>(board)));
}

bool Translator::run(Board& board, std::int32_t instructions) {
  Impl& own = *impl_;
  own.work = {};
  bool counted = true;
  if (own.may_translate(board))
    counted = own.run(board, instructions);
  else
    own.run_interpreted(board, instructions);
  if (counted) return true;
  own.budget.moving.spend(own.work.all());
  own.work = {};
  return false;
}

void Translator::earn(std::uint32_t drawing) { impl_->budget.earn(impl_->work, drawing); }

void Translator::set_code_capacity(std::size_t bytes) { translator::set_code_capacity(bytes); }

void Translator::set_boundless(bool on) { boundless = on; }

const char* Translator::obstacle() { return refusal().c_str(); }

}  // namespace racebeam
