// Splits a client's input into lines, in a buffer of fixed size.
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

  std::span<char> space();        // where the next input goes; never empty after line() returned nothing
  void added(std::size_t count);  // this many bytes were added there

  // Returns the next line without its LF, or the first `longest` bytes if they contain no LF. Returns nothing
  // if neither is complete. longest < kSize. The view is valid until space() is called.
  std::optional<std::string_view> line(std::size_t longest);

  // The bytes after the last line().
  std::string_view rest() const { return {buffer_.data() + begin_, end_ - begin_}; }

 private:
  std::array<char, kSize> buffer_;
  std::size_t begin_ = 0, end_ = 0;
};

}  // namespace racebeam
