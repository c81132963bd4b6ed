// The translated code of one cartridge image, shared by all machines in the process that run it.
#pragma once

#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <tuple>
#include <vector>

#include "emulator/cartridge/cartridge.hpp"
#include "emulator/cartridge/memory_map.hpp"
#include "emulator/state/state.hpp"
#include "emulator/translator/calling_convention.hpp"
#include "emulator/translator/code_memory.hpp"
#include "emulator/translator/host.hpp"

namespace racebeam {
class Board;
struct WriteLog;
}  // namespace racebeam

namespace racebeam::translator {

// A window of the image, at the addresses where the CPU sees it, and the blocks in it.
struct View {
  explicit View(const CodeWindow& window) : code(window), entries(window.span), known(window.span) {}

  const CodeWindow code;  // in the ImageCode's copy of the image
  // By offset in the window: the code of the block that starts there, or null, which other threads read; and
  // whether a block starts there, which the lock guards.
  std::vector<const void*> entries;
  std::vector<bool> known;

  static std::size_t bytes_of(const CodeWindow& window) {
    return sizeof(View) + window.span * sizeof(const void*) + window.span / 8;
  }

  const void* entry(std::uint16_t pc) {
    const auto offset = static_cast<std::uint16_t>(pc - code.first);
    return offset < code.span ? std::atomic_ref(entries[offset]).load(std::memory_order_acquire) : nullptr;
  }
};

class ImageCode {
 public:
  // Returns the code of this image that has room for more. Images are compared by their bytes. wiring: that
  // of the cartridge scheme, since two machines can run one image under different schemes. Returns null if
  // the code does not exist and `make` is false, or if the capacity of all code is used up. Throws
  // std::system_error if the system refuses executable memory.
  static std::shared_ptr<ImageCode> of(const Rom& rom, const Wiring& wiring, bool make);

  ImageCode(const Rom& rom, const Wiring& wiring, std::size_t capacity, bool shared);
  ~ImageCode();
  ImageCode(const ImageCode&) = delete;
  ImageCode& operator=(const ImageCode&) = delete;

  // Returns the view for this window of a machine's `rom`. Returns null if it does not fit, or if it does not
  // exist yet and `make` is false. To make one takes as long as some thousand instructions.
  View* view(const CodeWindow& window, const Rom& rom, bool make);

  // Translates code near `pc`, which must be in the view. Returns the block at `pc`, or null if it does
  // not fit.
  const void* translate(View& view, std::uint16_t pc, const Layout& layout);

  // Runs code from `entry` on. Returns the new PC, combined with kInterpretNext where that applies.
  using Enter = std::uint32_t(RACEBEAM_SYSV_ABI*)(const void* entry, Board* board, WriteLog* log);
  Enter enter() const { return enter_; }

  // Returns the bytes of the code of an image that has owners, with the data that belong to it.
  static std::size_t bytes_of_owned(const Rom& rom, std::size_t hash);

  // Whether the memory is full, so that translation starts again with new memory.
  bool is_full() const { return full_.load(std::memory_order_relaxed); }
  std::size_t bytes() const { return bytes_.load(std::memory_order_relaxed); }

 private:
  bool is_of(const Rom& rom, std::size_t hash) const;
  void make_stubs(const Layout& layout);
  bool has_room(std::size_t bytes) const;
  void count(std::size_t bytes);

  const Rom rom_;
  const std::size_t hash_;
  const Wiring wiring_;
  std::mutex mutex_;
  CodeMemory memory_;
  // Views by offset of the first byte in the image, first address, and number of addresses.
  std::map<std::tuple<std::size_t, std::uint16_t, std::uint16_t>, std::unique_ptr<View>> views_;
  Enter enter_ = nullptr;
  Stubs stubs_{};
  std::atomic<bool> full_ = false;
  const bool shared_;                   // false: its image has an owner, and its memory counts as the owner's
  std::atomic<std::size_t> bytes_ = 0;  // of code, views, and the copy of the image
  std::size_t bytes_of_views_ = 0;
};

// See Translator::set_code_capacity.
void set_code_capacity(std::size_t bytes);

}  // namespace racebeam::translator
