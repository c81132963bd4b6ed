// Input of a client, cut into lines, in a buffer that never grows.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>

namespace racebeam {

class LineBuffer {
 public:
  static constexpr std::size_t kSize = 4096;

  std::span<char> space();        // where the next input goes; never empty when line() has found nothing
  void added(std::size_t count);  // so much was put there

  // The next line without its LF, or the first `longest` bytes if there is no LF among them; nothing if
  // neither is there yet. longest < kSize. The view is good until space() is called.
  std::optional<std::string_view> line(std::size_t longest);

  // What line() has not given.
  std::string_view rest() const { return {buffer_.data() + begin_, end_ - begin_}; }

 private:
  std::array<char, kSize> buffer_;
  std::size_t begin_ = 0, end_ = 0;
};

}  // namespace racebeam
