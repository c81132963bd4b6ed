#include "emulator/translator/image_code.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <string_view>
#include <utility>

#include "emulator/board/board.hpp"
#include "emulator/translator/block_discovery.hpp"
#include "emulator/translator/block_emitter.hpp"
#include "emulator/translator/code_owner.hpp"

namespace racebeam::translator {
namespace {

std::atomic<std::size_t> code_capacity = 4U << 20;
std::atomic<std::size_t> most_shared = std::numeric_limits<std::size_t>::max(), bytes_shared = 0;

constexpr std::size_t kBatchCapacity = 1U << 16;  // bytes; with less memory left, no batch is begun
constexpr std::size_t kViewCapacity = 4U << 20;   // bytes for the views of an image
constexpr std::size_t kUsualPage = 4096;

// Each batch begins on a new page. With larger pages, the memory is larger, so that as many batches fit.
std::size_t memory_for(std::size_t capacity) {
  return std::max(capacity, 2 * kBatchCapacity) / kUsualPage * std::max(page_size(), kUsualPage);
}

// All code, and the images that have owners.
struct Registry {
  std::mutex mutex;
  std::vector<std::weak_ptr<ImageCode>> codes;
  std::vector<const Rom*> owned;  // has an image once for each of its owners

  bool is_owned(const Rom& rom) const { return std::ranges::find(owned, &rom) != owned.end(); }
};

Registry& registry() {
  static Registry all;
  return all;
}

// Hashes are compared first: without them, many images that differ only in the last byte would be slow to
// compare.
std::size_t hash_of(const Rom& rom) {
  return std::hash<std::string_view>()({reinterpret_cast<const char*>(rom.data()), rom.size()});
}

bool is_room_for(std::size_t bytes) { return bytes_shared + bytes <= most_shared; }

}  // namespace

void set_code_capacity(std::size_t bytes) { code_capacity = bytes; }

std::shared_ptr<ImageCode> ImageCode::of(const Rom& rom, const Wiring& wiring, bool make) {
  Registry& all = registry();
  const std::size_t hash = hash_of(rom);
  const std::lock_guard lock(all.mutex);
  std::erase_if(all.codes, [](const auto& one) { return one.expired(); });
  for (const auto& one : all.codes) {
    const auto code = one.lock();
    if (code && !code->is_full() && code->wiring_ == wiring && code->is_of(rom, hash)) return code;
  }
  const bool shared = !all.is_owned(rom);
  if (!make || (shared && !is_room_for(rom.size() + kBatchCapacity))) return nullptr;
  auto code = std::make_shared<ImageCode>(rom, wiring, code_capacity, shared);
  all.codes.push_back(code);
  return code;
}

std::size_t ImageCode::bytes_of_owned(const Rom& rom, std::size_t hash) {
  Registry& all = registry();
  const std::lock_guard lock(all.mutex);
  std::size_t bytes = 0;
  for (const auto& one : all.codes) {
    const auto code = one.lock();
    if (code && !code->shared_ && code->is_of(rom, hash)) bytes += code->bytes_;
  }
  return bytes;
}

bool ImageCode::is_of(const Rom& rom, std::size_t hash) const { return hash_ == hash && rom_ == rom; }

ImageCode::ImageCode(const Rom& rom, const Wiring& wiring, std::size_t capacity, bool shared)
    : rom_(rom), hash_(hash_of(rom)), wiring_(wiring), memory_(memory_for(capacity)), shared_(shared) {
  count(sizeof *this + rom_.size());
}

ImageCode::~ImageCode() {
  if (shared_) bytes_shared -= bytes_;
}

// Machines on several threads check the capacity before they count their bytes. Each may exceed it by a
// batch.
bool ImageCode::has_room(std::size_t bytes) const { return !shared_ || is_room_for(bytes); }

void ImageCode::count(std::size_t bytes) {
  bytes_ += bytes;
  if (shared_) bytes_shared += bytes;
}

View* ImageCode::view(const CodeWindow& window, const Rom& rom, bool make) {
  const auto rom_offset = static_cast<std::size_t>(window.memory - rom.data());
  const std::tuple place(rom_offset, window.first, window.span);
  const std::lock_guard lock(mutex_);
  if (const auto found = views_.find(place); found != views_.end()) return found->second.get();
  const std::size_t bytes = View::bytes_of(window);
  if (!make || bytes_of_views_ + bytes > kViewCapacity || !has_room(bytes)) return nullptr;
  auto view = std::make_unique<View>(CodeWindow{rom_.data() + rom_offset, window.first, window.span});
  bytes_of_views_ += bytes;
  count(bytes);
  return views_.emplace(place, std::move(view)).first->second.get();
}

void ImageCode::make_stubs(const Layout& layout) {
  stubs_ = emit_stubs(memory_.writable(), memory_.left(), layout);
  count(memory_.seal(stubs_.size));
  // NOLINTNEXTLINE(performance-no-int-to-ptr)
  enter_ = reinterpret_cast<Enter>(reinterpret_cast<std::uintptr_t>(stubs_.enter));
}

const void* ImageCode::translate(View& view, std::uint16_t pc, const Layout& layout) {
  const std::lock_guard lock(mutex_);
  if (const void* entry = view.entry(pc)) return entry;
  if (memory_.left() < kBatchCapacity) full_ = true;
  if (full_ || !has_room(kBatchCapacity)) return nullptr;
  const CodeWriting writing;
  if (enter_ == nullptr) make_stubs(layout);
  const Window window{wiring_, rom_.data(), view.code, view.entries.data()};
  Assembler assembler(memory_.writable(), memory_.left(), layout, window, stubs_);
  const std::vector<Block> blocks = discover(view.code, pc, view.known);
  try {
    for (const Block& block : blocks) assembler.blocks[block.pc];
    for (const Block& block : blocks) BlockEmitter(assembler, block).emit();
  } catch (const AssemblyError&) {  // The code memory is full.
    full_ = true;
    return nullptr;
  }
  count(memory_.seal(assembler.size()));
  for (const Block& block : blocks) {
    const auto offset = static_cast<std::uint16_t>(block.pc - view.code.first);
    view.known[offset] = true;
    const void* start = assembler.address_of(block.pc);
    std::atomic_ref(view.entries[offset]).store(start, std::memory_order_release);
  }
  return view.entry(pc);
}

}  // namespace racebeam::translator

namespace racebeam {

CodeOwner::CodeOwner(std::shared_ptr<const Rom> image)
    : image_(std::move(image)), hash_(translator::hash_of(*image_)) {
  auto& all = translator::registry();
  const std::lock_guard lock(all.mutex);
  all.owned.push_back(image_.get());
}

CodeOwner::~CodeOwner() {
  auto& all = translator::registry();
  const std::lock_guard lock(all.mutex);
  all.owned.erase(std::ranges::find(all.owned, image_.get()));
}

std::size_t CodeOwner::bytes() const { return translator::ImageCode::bytes_of_owned(*image_, hash_); }

void limit_shared_code(std::size_t bytes) { translator::most_shared = bytes; }
std::size_t shared_code() { return translator::bytes_shared; }

}  // namespace racebeam
