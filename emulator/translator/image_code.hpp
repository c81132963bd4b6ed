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
#include "emulator/translator/assembler.hpp"
#include "emulator/translator/code_memory.hpp"
#include "emulator/translator/profitability.hpp"

namespace racebeam {
struct WriteLog;
}

namespace racebeam::translator {

// A run of the image that the CPU sees at certain addresses, and its blocks.
struct View {
  explicit View(const CodeWindow& window)
      : code(window), entries(window.span), worth(window.span), known(window.span) {}

  const CodeWindow code;             // in the copy of the image that belongs to the code
  std::vector<const void*> entries;  // by offset: where the block that starts there begins; read by other threads
  std::vector<Worth> worth;          // by offset: of the blocks that start there
  std::vector<bool> known;           // by offset: where blocks start, for the translator alone

  const void* entry(std::uint16_t pc) {
    const auto offset = static_cast<std::uint16_t>(pc - code.first);
    return offset < code.span ? std::atomic_ref(entries[offset]).load(std::memory_order_acquire) : nullptr;
  }
};

class ImageCode {
 public:
  // Of an image like this one, made when it is first asked for. wiring: of the cartridge scheme; two
  // machines can run one image under different schemes. Throws std::system_error where executable memory is refused.
  static std::shared_ptr<ImageCode> of(const Rom& rom, const Wiring& wiring);

  ImageCode(const Rom& rom, const Wiring& wiring, std::size_t capacity);

  // The view through this window of a machine's memory. Null if it shows something else than this image, or if there is none
  // yet and `make` is false: to make one takes as long as some thousand instructions.
  View* view(const CodeWindow& window, const Rom& rom, bool make);

  // Translates what is near to `pc`, which must be in the view. Null if there is no room.
  const void* translate(View& view, std::uint16_t pc, const Layout& layout);

  // Runs from `entry` on; returns the new PC, with kInterpretNext or not.
  using Enter = std::uint32_t (*)(const void* entry, Board* board, WriteLog* log);
  Enter enter() const { return enter_; }

  bool is_full() const { return full_.load(std::memory_order_relaxed); }

 private:
  void make_gates(const Layout& layout);

  const Rom rom_;
  const Wiring wiring_;
  std::mutex mutex_;
  CodeMemory memory_;
  // By the offset of its first byte in the image, the first address, and how many addresses there are.
  std::map<std::tuple<std::size_t, std::uint16_t, std::uint16_t>, std::unique_ptr<View>> views_;
  Enter enter_ = nullptr;
  const void* way_out_ = nullptr;
  std::atomic<bool> full_ = false;
};

// The most bytes of translated code for one image; applies to images that are translated from now on.
void set_code_capacity(std::size_t bytes);

}  // namespace racebeam::translator
