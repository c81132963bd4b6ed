#include "emulator/translator/image_code.hpp"

#include <algorithm>

#include "emulator/board.hpp"
#include "emulator/translator/block_emitter.hpp"
#include "emulator/translator/program.hpp"

namespace racebeam::translator {
namespace {

std::atomic<std::size_t> code_capacity = 4U << 20;

constexpr std::size_t kRoomForBatch = 1U << 16;  // less than this is not begun with
constexpr std::size_t kMostViews = 256;          // 36 KiB each at most; real cartridges have up to 30

std::uint64_t key_of(std::size_t rom_offset, const CodeWindow& window) {
  return std::uint64_t{rom_offset} << 32 | std::uint64_t{window.first} << 16 | window.span;
}

}  // namespace

// Blocks that are published together, since they lead to each other: begun by one machine, and finished by
// those that can pay.
struct Batch {
  Batch(View& seen, const Wiring& wiring, const Layout& layout, CodeMemory& memory, const void* way_out)
      : view(seen),
        window{wiring, seen.code, seen.entries.data()},
        assembler(memory.writable(), memory.left(), layout, window, way_out) {}

  View& view;
  const Window window;
  Assembler assembler;
  std::vector<Block> blocks;
  std::size_t emitted = 0;
};

void set_code_capacity(std::size_t bytes) { code_capacity = bytes; }

std::shared_ptr<ImageCode> ImageCode::of(const Rom& rom, const Wiring& wiring, const Layout& layout) {
  static std::mutex mutex;
  static std::vector<std::weak_ptr<ImageCode>> all;
  const std::lock_guard lock(mutex);
  std::erase_if(all, [](const auto& one) { return one.expired(); });
  for (const auto& one : all) {
    const auto code = one.lock();
    if (code && !code->is_full() && code->wiring_ == wiring && std::ranges::equal(code->rom_, rom))
      return code;
  }
  auto code = std::make_shared<ImageCode>(rom, wiring, layout, code_capacity);
  all.push_back(code);
  return code;
}

ImageCode::ImageCode(const Rom& rom, const Wiring& wiring, const Layout& layout, std::size_t capacity)
    : rom_(rom), wiring_(wiring), layout_(layout), memory_(std::max(capacity, 2 * kRoomForBatch)) {
  make_gates();
}

ImageCode::~ImageCode() = default;

View* ImageCode::view(const CodeWindow& window, const Rom& rom, Purse& purse) {
  const std::less<> before;
  if (before(window.memory, rom.data()) || !before(window.memory, rom.data() + rom.size())) return nullptr;
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock.owns_lock()) return nullptr;
  const auto rom_offset = static_cast<std::size_t>(window.memory - rom.data());
  const auto found = views_.find(key_of(rom_offset, window));
  if (found != views_.end()) return found->second.get();
  if (!purse.can_pay(kViewPrice)) return nullptr;
  purse.spend(kViewPrice);
  if (views_.size() == kMostViews) full_ = true;
  if (full_) return nullptr;
  const CodeWindow own{rom_.data() + rom_offset, window.first, window.span};
  return (views_[key_of(rom_offset, window)] = std::make_unique<View>(own, rom_offset)).get();
}

// The way in: saves what belongs to the caller, loads the 6507's registers and jumps. The way out: the
// reverse.
void ImageCode::make_gates() {
  using namespace Xbyak::util;
  Xbyak::CodeGenerator as(memory_.left(), memory_.writable());
  const Xbyak::Reg64 saved[] = {rbx, rbp, r12, r13, r14, r15};
  const auto in = [&](const Xbyak::Reg32& reg, std::int32_t place) { as.movzx(reg, byte[rbx + place]); };
  const auto out = [&](const Xbyak::Reg8& reg, std::int32_t place) { as.mov(byte[rbx + place], reg); };
  const void* enter = as.getCurr();
  for (const auto& reg : saved) as.push(reg);
  as.sub(rsp, 24);
  as.mov(rbx, rsi);
  as.mov(r15, rdx);
  in(r12d, layout_.a), in(r13d, layout_.x), in(r14d, layout_.y);
  as.mov(ebp, dword[rbx + layout_.cycle]);
  as.mov(r8d, dword[rbx + layout_.nz]);
  as.mov(r9d, dword[rbx + layout_.carry]);
  as.jmp(rdi);
  way_out_ = as.getCurr();
  out(r12b, layout_.a), out(r13b, layout_.x), out(r14b, layout_.y);
  as.mov(dword[rbx + layout_.cycle], ebp);
  as.mov(dword[rbx + layout_.nz], r8d);
  as.mov(dword[rbx + layout_.carry], r9d);
  as.add(rsp, 24);
  std::for_each(std::rbegin(saved), std::rend(saved), [&](const auto& reg) { as.pop(reg); });
  as.ret();
  memory_.seal(as.getSize());
  enter_ = reinterpret_cast<Enter>(reinterpret_cast<std::uintptr_t>(enter));
}

const void* ImageCode::translate(View& view, std::uint16_t pc, Purse& purse) {
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock.owns_lock()) return nullptr;
  try {
    while (!full_ && view.entry(pc) == nullptr && !purse.is_empty()) {
      if (!batch_ && !purse.can_pay(kBatchPrice)) break;
      if (!batch_)
        begin_batch(view, pc, purse);
      else if (batch_->emitted < batch_->blocks.size())
        emit_block(purse);
      else
        publish();
    }
  } catch (const std::exception&) {  // out of room, or the system refuses
    batch_.reset();
    full_ = true;
  }
  return view.entry(pc);
}

void ImageCode::begin_batch(View& view, std::uint16_t pc, Purse& purse) {
  full_ = memory_.left() < kRoomForBatch;
  if (full_) return;
  batch_ = std::make_unique<Batch>(view, wiring_, layout_, memory_, way_out_);
  batch_->blocks = discover(batch_->window, pc, view.known);
  Cost instructions = 0;
  for (const Block& block : batch_->blocks) {
    batch_->assembler.blocks[block.pc];
    instructions += static_cast<Cost>(block.instructions.size());
  }
  purse.spend(kBatchPrice + instructions * kFindingPrice);
}

void ImageCode::emit_block(Purse& purse) {
  const Block& block = batch_->blocks[batch_->emitted++];
  BlockEmitter(batch_->assembler, block).emit();
  purse.spend(kBlockPrice + static_cast<Cost>(block.instructions.size()) * kEmittingPrice);
}

void ImageCode::publish() {
  const std::unique_ptr<Batch> done = std::move(batch_);
  View& view = done->view;
  memory_.seal(done->assembler.getSize());
  for (const Block& block : done->blocks) {
    const auto offset = static_cast<std::uint16_t>(block.pc - view.code.first);
    view.known[offset] = true;
    const void* start = done->assembler.blocks[block.pc].getAddress();
    std::atomic_ref(view.entries[offset]).store(start, std::memory_order_release);
  }
}

}  // namespace racebeam::translator
