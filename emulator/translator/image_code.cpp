#include "emulator/translator/image_code.hpp"

#include <algorithm>

#include "emulator/board/board.hpp"
#include "emulator/translator/block_discovery.hpp"
#include "emulator/translator/block_emitter.hpp"

namespace racebeam::translator {
namespace {

std::atomic<std::size_t> code_capacity = 4U << 20;

constexpr std::size_t kBatchCapacity = 1U << 16;  // a batch is begun only with this much memory left

}  // namespace

void set_code_capacity(std::size_t bytes) { code_capacity = bytes; }

std::shared_ptr<ImageCode> ImageCode::of(const Rom& rom, const Wiring& wiring, bool make) {
  static std::mutex mutex;
  static std::vector<std::weak_ptr<ImageCode>> all;
  const std::lock_guard lock(mutex);
  std::erase_if(all, [](const auto& one) { return one.expired(); });
  for (const auto& one : all) {
    const auto code = one.lock();
    if (code && !code->is_full() && code->wiring_ == wiring && std::ranges::equal(code->rom_, rom))
      return code;
  }
  if (!make) return nullptr;
  auto code = std::make_shared<ImageCode>(rom, wiring, code_capacity);
  all.push_back(code);
  return code;
}

ImageCode::ImageCode(const Rom& rom, const Wiring& wiring, std::size_t capacity)
    : rom_(rom), wiring_(wiring), memory_(std::max(capacity, 2 * kBatchCapacity)) {}

View* ImageCode::view(const CodeWindow& window, const Rom& rom, bool make) {
  const auto rom_offset = static_cast<std::size_t>(window.memory - rom.data());
  const std::lock_guard lock(mutex_);
  std::unique_ptr<View>& view = views_[{rom_offset, window.first, window.span}];
  if (view == nullptr && make)
    view = std::make_unique<View>(CodeWindow{rom_.data() + rom_offset, window.first, window.span});
  return view.get();
}

// The entry stub saves the host's registers, loads the 6507's and jumps to a block. The exit stub does the
// reverse.
void ImageCode::emit_stubs(const Layout& layout) {
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
  in(r12d, layout.a), in(r13d, layout.x), in(r14d, layout.y);
  as.mov(ebp, dword[rbx + layout.cycle]);
  as.mov(r8d, dword[rbx + layout.nz]);
  as.mov(r9d, dword[rbx + layout.carry]);
  as.jmp(rdi);
  exit_stub_ = as.getCurr();
  out(r12b, layout.a), out(r13b, layout.x), out(r14b, layout.y);
  as.mov(dword[rbx + layout.cycle], ebp);
  as.mov(dword[rbx + layout.nz], r8d);
  as.mov(dword[rbx + layout.carry], r9d);
  as.add(rsp, 24);
  std::for_each(std::rbegin(saved), std::rend(saved), [&](const auto& reg) { as.pop(reg); });
  as.ret();
  memory_.seal(as.getSize());
  enter_ =
      reinterpret_cast<Enter>(reinterpret_cast<std::uintptr_t>(enter));  // NOLINT(performance-no-int-to-ptr)
}

const void* ImageCode::translate(View& view, std::uint16_t pc, const Layout& layout) {
  const std::lock_guard lock(mutex_);
  if (const void* entry = view.entry(pc)) return entry;
  if (memory_.left() < kBatchCapacity) full_ = true;
  if (full_) return nullptr;
  if (enter_ == nullptr) emit_stubs(layout);
  const Window window{wiring_, view.code, view.entries.data()};
  Assembler assembler(memory_.writable(), memory_.left(), layout, window, exit_stub_);
  const std::vector<Block> blocks = discover(view.code, pc, view.known);
  try {
    for (const Block& block : blocks) assembler.blocks[block.pc];
    for (const Block& block : blocks) BlockEmitter(assembler, block).emit();
  } catch (const Xbyak::Error&) {  // The code memory is full.
    full_ = true;
    return nullptr;
  }
  memory_.seal(assembler.getSize());
  for (const Block& block : blocks) {
    const auto offset = static_cast<std::uint16_t>(block.pc - view.code.first);
    view.known[offset] = true;
    view.profitability[offset].set_length(block.instructions.size() + 1);
    const void* start = assembler.blocks[block.pc].getAddress();
    std::atomic_ref(view.entries[offset]).store(start, std::memory_order_release);
  }
  return view.entry(pc);
}

}  // namespace racebeam::translator
