#include "emulator/translator/translator.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <system_error>

#include "emulator/board/board.hpp"
#include "emulator/cpu/cpu.hpp"
#include "emulator/translator/image_code.hpp"
#include "emulator/translator/program.hpp"

namespace racebeam {
namespace {

// No block lasts longer, so that a write in it comes before the line limit if the block starts before it by this much.
constexpr std::int32_t kMargin = 400;

// Instructions that the interpreter runs at a time where there is nothing to translate: code in RAM, mostly.
constexpr std::int32_t kElsewhere = 8;
constexpr std::int32_t kWithoutBudget = 64;  // the same, where code may not be made now

constexpr std::int32_t kFewestCycles = 2;  // of an instruction

// What a machine may spend on making code, in nanoseconds: a start, which is more than the code of any game takes, and a part
// of the time that the interpreter would take. Prices, and 1 ns a cycle, as measured on a Zen 5 processor; no clock is looked
// at, so that two runs do the same.
class Budget {
 public:
  bool allows() const { return left_ > 0; }
  void earn(std::int32_t cycles) { left_ = std::min(left_ + cycles / kPart, kStart); }
  void spend_on_batch(std::size_t bytes) { left_ -= 6000 + 9 * static_cast<std::int64_t>(bytes); }
  void spend_on_generation() { left_ -= 100'000; }

 private:
  static constexpr std::int64_t kStart = 4'000'000;
  static constexpr std::int32_t kPart = 5;

  std::int64_t left_ = kStart;
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
  explicit Impl(Board& board)
      : code(translator::ImageCode::of(board.slot.rom, {board.plain_registers(), board.slot.scheme.port_reader})), layout(board) {}

  // Windows that were looked into before, by their place: a bank switch finds its way back without asking the image.
  struct Seen {
    CodeWindow window;
    translator::View* view = nullptr;
  };

  translator::View* current_view(Board& board);
  const void* entry(Board& board);
  bool enter(Board& board, const void* entry);

  std::shared_ptr<translator::ImageCode> code;
  const translator::Layout layout;
  std::array<Seen, 32> seen{};
  Budget budget;
};

translator::View* Translator::Impl::current_view(Board& board) {
  const std::uint16_t pc = board.state.cpu.PC;
  if (static_cast<std::uint16_t>(pc - board.code.first) >= board.code.span && !board.find_code(pc)) return nullptr;
  const std::uintptr_t place = reinterpret_cast<std::uintptr_t>(board.code.memory) / MemoryMap::kPageSize;
  Seen& known = seen[(place ^ board.code.first / 1024U) % seen.size()];
  if (known.view == nullptr || !same(known.window, board.code)) known = {board.code, code->view(board.code, board.slot.rom)};
  return known.view;
}

// Where the block at PC starts, made if need be; null if the interpreter must go on.
const void* Translator::Impl::entry(Board& board) {
  translator::View* view = current_view(board);
  if (view == nullptr) return nullptr;
  if (const void* known = view->entry(board.state.cpu.PC)) return known;
  if (!translator::holds(view->code, board.state.cpu.PC) || code->is_full() || !budget.allows()) return nullptr;
  std::size_t bytes = 0;
  const void* entry = code->translate(*view, board.state.cpu.PC, layout, bytes);
  budget.spend_on_batch(bytes);
  return entry;
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
  const std::int32_t first_cycle = board.state.cycle;
  const bool counted = run_on(board, instructions, first_cycle);
  impl_->budget.earn(board.state.cycle - first_cycle);
  return counted;
}

bool Translator::run_on(Board& board, std::int32_t instructions, std::int32_t first_cycle) {
  if (impl_->code->is_full()) renew(board);
  board.stop = false;
  const std::int32_t limit = board.translated.limit = board.overlong_cycle() - kMargin;
  board.translated.first_line = board.state.tia.origin / 3;
  while (!board.stop && !board.state.cpu.jammed) {
    if (board.state.cycle >= limit) {
      interpret(board, instructions - (board.state.cycle - first_cycle) / kFewestCycles);
      return board.stop || board.state.cpu.jammed || first_cycle >= limit;
    }
    const void* start = impl_->entry(board);
    if (start != nullptr && !impl_->enter(board, start)) continue;
    if (!board.stop) interpret(board, start != nullptr ? 1 : impl_->budget.allows() ? kElsewhere : kWithoutBudget);
  }
  return true;
}

// A new generation of code, since the old one is full. The budget goes on.
void Translator::renew(Board& board) {
  Budget budget = impl_->budget;
  budget.spend_on_generation();
  if (!budget.allows()) return;
  impl_ = std::make_unique<Impl>(board);
  impl_->budget = budget;
}

void Translator::set_code_capacity(std::size_t bytes) { translator::set_code_capacity(bytes); }

const char* Translator::obstacle() { return refusal().c_str(); }

}  // namespace racebeam
