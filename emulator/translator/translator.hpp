// Runs a machine's 6507 code as x86-64 code, and the rest with the interpreter (docs/translator.md).
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "emulator/translator/image_code.hpp"

namespace racebeam::translator {

// One machine's way to the translated code of its image.
class Translator {
 public:
  explicit Translator(Board& board);  // throws std::system_error where executable memory is refused

  // Like interpret(), but the instructions are not counted. False if there may have been `instructions` of them before
  // the frame closed: then there were no more, and the step must be run again by who counts.
  bool run(Board& board, std::int32_t instructions);

 private:
  const void* entry(Board& board);
  View* current_view(Board& board);
  bool enter(Board& board, const void* entry);

  std::shared_ptr<ImageCode> code_;
  Layout layout_;
  std::uint64_t plain_registers_;

  // The windows that were looked into last: a bank switch finds its way back without asking the image.
  struct Seen {
    CodeWindow window;
    View* view = nullptr;
  };
  std::array<Seen, 8> seen_{};
  std::size_t next_seen_ = 0;
  Seen current_{};
};

}  // namespace racebeam::translator
