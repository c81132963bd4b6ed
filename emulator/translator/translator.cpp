#include "emulator/translator/translator.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <string>
#include <system_error>

#include "emulator/base/stopwatch.hpp"
#include "emulator/board/board.hpp"
#include "emulator/cpu/cpu.hpp"
#include "emulator/policies/interpreted_run.hpp"
#include "emulator/policies/profitability.hpp"
#include "emulator/policies/step_backoff.hpp"
#include "emulator/policies/step_trial.hpp"
#include "emulator/policies/translation_budget.hpp"
#include "emulator/policies/tuning.hpp"
#include "emulator/translator/block_discovery.hpp"
#include "emulator/translator/image_code.hpp"

namespace racebeam {

namespace {

// In cycles. No block takes more, so a block that starts this long before the line limit makes its TIA writes
// before the limit.
const std::int32_t kMargin = tuning::kMaxBlockCycles + 100;

constexpr std::int32_t kFewestCycles = 2;  // of an instruction

// Code outside the image, mostly in RAM, may change, and is not translated.
bool is_in_image(const CodeWindow& window, const Rom& rom) {
  const std::less<> before;
  return !before(window.memory, rom.data()) && before(window.memory, rom.data() + rom.size());
}

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

// Why the system refuses executable memory; empty if it permits that. It is tried once per process.
const std::string& executable_memory_error() {
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
  // Code that another machine has made is used at once: the budget is only for translation.
  Impl(Board& board, bool always) : code(code_of(board, false)), layout(board), budget(always) {}

  // A window that was looked up before, cached by its address. With it, a view is found after a bank switch
  // without a search in the image.
  struct CachedView {
    CodeWindow window;
    translator::View* view = nullptr;
  };

  // Where the instruction at PC is.
  enum class Place { kImage, kOtherMemory, kDevice };

  // The translated code of the instruction at PC; null if it does not exist. Only code in the image is
  // translated.
  struct Entry {
    Place place;
    const void* start = nullptr;
  };

  static std::shared_ptr<translator::ImageCode> code_of(Board& board, bool make);
  bool has_code(Board& board);
  translator::View* current_view(Board& board);
  translator::View* find_view(const CodeWindow& window, const Rom& rom);
  Entry find_entry(Board& board);
  bool interprets_step();
  bool enter(Board& board, const void* start);
  std::int32_t run_block(Board& board, const void* start);

  std::shared_ptr<translator::ImageCode> code;  // null: no code exists, and no budget for it
  const translator::Layout layout;
  std::array<CachedView, 32> views{};
  TranslationBudget budget;
  Profitability profitability;
  InterpretedRun interpreted_run;
  StepBackoff step_backoff;
  StepTrial trial;
  std::optional<Stopwatch> trial_watch;  // during steps of a trial
  std::int64_t interpreted_cycles = 0;
};

std::shared_ptr<translator::ImageCode> Translator::Impl::code_of(Board& board, bool make) {
  const translator::Wiring wiring{board.plain_registers(), board.slot.scheme.port_reader};
  return translator::ImageCode::of(board.slot.rom, wiring, make);
}

// Returns whether there is code for this image. When the code memory is full, begins with new memory if the
// budget allows that.
bool Translator::Impl::has_code(Board& board) {
  const bool is_useful = code != nullptr && !code->is_full();
  if (is_useful || !budget.covers_batch()) return code != nullptr;
  const TranslationBudget::Charge charge(budget);
  try {
    if (auto image_code = code_of(board, true)) {
      code = std::move(image_code);
      views = {};
    }
  } catch (const std::system_error&) {
    // The system has no memory for code now. A later step tries again.
  }
  return code != nullptr;
}

translator::View* Translator::Impl::current_view(Board& board) {
  const std::uint16_t pc = board.state.cpu.PC;
  if (!translator::contains(board.code, pc) && !board.find_code(pc)) return nullptr;
  const std::uintptr_t place = reinterpret_cast<std::uintptr_t>(board.code.memory) / MemoryMap::kPageSize;
  CachedView& cached = views[(place ^ board.code.first / 1024U) % views.size()];
  if (cached.view == nullptr || !same(cached.window, board.code)) {
    if (!is_in_image(board.code, board.slot.rom)) return nullptr;
    cached = {board.code, find_view(board.code, board.slot.rom)};
  }
  return cached.view;
}

// Finds the view. If it does not exist, makes it if the budget allows that.
translator::View* Translator::Impl::find_view(const CodeWindow& window, const Rom& rom) {
  translator::View* const view = code->view(window, rom, false);
  if (view != nullptr || !budget.covers_batch()) return view;
  const TranslationBudget::Charge charge(budget);
  return code->view(window, rom, true);
}

// Finds the block at PC, and translates it if the budget allows that.
Translator::Impl::Entry Translator::Impl::find_entry(Board& board) {
  translator::View* view = current_view(board);
  const std::uint16_t pc = board.state.cpu.PC;
  if (view == nullptr || !translator::contains(view->code, pc))
    return {translator::contains(board.code, pc) ? Place::kOtherMemory : Place::kDevice};
  if (const void* block = view->entry(pc)) return {Place::kImage, block};
  if (code->is_full() || !budget.covers_batch()) return {Place::kImage};
  const TranslationBudget::Charge charge(budget);
  return {Place::kImage, code->translate(*view, pc, layout)};
}

// Returns whether the interpreter must execute the next instruction.
bool Translator::Impl::enter(Board& board, const void* start) {
  translator::Context& context = board.translator_context;
  unpack_status(context, board.state.cpu.P);
  const std::uint32_t exit = code->enter()(start, &board, board.log);
  board.state.cpu.PC = static_cast<std::uint16_t>(exit);
  board.state.cpu.P = pack_status(context);
  return (exit & translator::kInterpretNext) != 0;
}

// Runs translated code from `start` on, if that pays. Returns how many instructions the interpreter must
// execute next.
std::int32_t Translator::Impl::run_block(Board& board, const void* start) {
  if (!budget.is_unlimited() && profitability.is_unprofitable()) return interpreted_run.next(1);
  const std::int32_t first = board.state.cycle;
  const std::uint32_t waited_before = board.translator_context.waited;
  const bool interpret_next = enter(board, start);
  const auto waited = static_cast<std::int32_t>(board.translator_context.waited - waited_before);
  const std::int32_t cycles = board.state.cycle - first - waited;
  if (!board.stop) profitability.record(cycles);
  if (cycles >= tuning::kBreakEvenCycles) interpreted_run.reset();
  return interpret_next ? 1 : 0;
}

Translator::Translator(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Translator::~Translator() = default;

std::unique_ptr<Translator> Translator::make(Board& board, CpuKind kind) {
  if (kind == CpuKind::kInterpreter || board.must_be_interpreted()) return nullptr;
  if (!executable_memory_error().empty()) {
    if (kind == CpuKind::kAuto) return nullptr;
    throw std::system_error(std::make_error_code(std::errc::permission_denied), executable_memory_error());
  }
  return std::unique_ptr<Translator>(
      new Translator(std::make_unique<Impl>(board, kind == CpuKind::kTranslator || policies_are_fixed())));
}

// Begins a step. Returns whether the interpreter runs the whole step.
bool Translator::Impl::interprets_step() {
  trial_watch.reset();
  if (code == nullptr || budget.is_unlimited()) return false;
  const bool interprets = trial.begin_step();
  if (trial.measures()) trial_watch.emplace();
  return interprets;
}

bool Translator::run(Board& board, std::int32_t instructions) {
  impl_->budget.begin_step();
  if (impl_->interprets_step() || impl_->step_backoff.skips_step() || !impl_->has_code(board)) {
    interpret_some(board, instructions, instructions);
    return true;
  }
  const bool begins_frame = board.state.cycle < board.overlong_cycle() - kMargin;
  const bool whole = run_blocks(board, instructions);
  if (begins_frame) impl_->step_backoff.record(whole);
  return whole;
}

bool Translator::run_blocks(Board& board, std::int32_t instructions) {
  board.stop = false;
  const std::int32_t first_cycle = board.state.cycle;
  const std::int32_t limit = board.translator_context.limit = board.overlong_cycle() - kMargin;
  board.translator_context.first_line = board.state.tia.origin / 3;
  while (!board.stop && !board.state.cpu.jammed) {
    const std::int32_t remaining = instructions - (board.state.cycle - first_cycle) / kFewestCycles;
    if (board.state.cycle >= limit || remaining <= 0) {
      interpret_some(board, remaining, remaining);
      return board.stop || board.state.cpu.jammed || first_cycle >= limit;
    }
    const Impl::Entry entry = impl_->find_entry(board);
    const std::int32_t minimum = entry.place == Impl::Place::kImage ? 1 : tuning::kOutsideImage;
    const std::int32_t run =
        entry.start != nullptr ? impl_->run_block(board, entry.start) : impl_->interpreted_run.next(minimum);
    if (run == 0 || board.stop) continue;
    const bool ends_exactly = run == 1 || remaining < run + tuning::kRunSlack;
    const std::int32_t enough = std::min(run, remaining);
    // A routine in RAM mostly jumps back to translated code.
    const bool stays = entry.place == Impl::Place::kOtherMemory && run == tuning::kOutsideImage;
    interpret_some(board, ends_exactly ? enough : run + tuning::kRunSlack, enough, stays);
  }
  return true;
}

void Translator::interpret_some(Board& board, std::int32_t most, std::int32_t enough, bool stays) {
  const std::int32_t first = board.state.cycle;
  interpret(board, most, enough, stays);
  impl_->interpreted_cycles += board.state.cycle - first;
}

std::int64_t Translator::interpreted_cycles() const { return impl_->interpreted_cycles; }

void Translator::end_step() {
  if (impl_->trial_watch) impl_->trial.end_step(impl_->trial_watch->elapsed() - impl_->budget.spent());
  impl_->budget.end_step();
}

void Translator::set_code_capacity(std::size_t bytes) { translator::set_code_capacity(bytes); }

const char* Translator::obstacle() { return executable_memory_error().c_str(); }

}  // namespace racebeam
