// Input of a client of the line protocol, cut into lines. Grows with the line that is coming in, up to a
// limit; a longer line is told once and skipped.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace racebeam {

class LineReader {
 public:
  explicit LineReader(std::size_t longest) : longest_(longest) {}

  void set_longest(std::size_t longest) { longest_ = longest; }
  std::size_t longest() const { return longest_; }

  std::size_t growth() const;  // bytes of memory that space() would take
  void cut_line();             // there is no memory for the line that is coming in: it is too long
  std::size_t capacity() const { return buffer_.capacity(); }
  std::span<char> space();        // where the next input goes; empty while a longest line waits unread
  void added(std::size_t count);  // so much was put there
  void end() { ended_ = true; }   // no more will come
  bool ended() const { return ended_; }

  enum class Kind { kLine, kTooLong, kHalf };
  struct Line {
    Kind kind;
    std::string_view text;  // without LF, and without a CR before it; good until space() is called
  };
  std::optional<Line> next();
  bool empty() const { return unread() == 0; }  // next() has given all that came
  std::size_t lines(std::size_t most) const;    // whole ones that wait; counted up to `most`

 private:
  std::size_t unread() const { return end_ - begin_; }
  void shrink();
  std::size_t grown_size() const;

  std::size_t longest_;
  std::string buffer_;
  std::size_t begin_ = 0, end_ = 0;  // of what next() has not given
  std::size_t searched_ = 0;         // bytes from begin_ in which there is no LF
  bool skipping_ = false;            // within a line that was too long
  bool cut_ = false;                 // there is no memory for the line
  bool ended_ = false;
};

}  // namespace racebeam
