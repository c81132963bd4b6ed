// Splits a client's input of the line protocol into lines. The buffer grows with the incoming line, up to a
// limit. A longer line is reported once and skipped, as is a line for which memory does not suffice.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace racebeam {

class LineReader {
 public:
  explicit LineReader(std::size_t longest);

  void set_longest(std::size_t longest) { longest_ = longest; }
  std::size_t longest() const { return longest_; }

  // After next() has returned nothing: how many bytes of memory the rest of the line needs now, usually 0. If
  // memory suffices, grow() allocates them, and may throw std::bad_alloc. Otherwise cut_line() makes next()
  // return the line as kCut.
  std::size_t growth() const;
  void grow();
  void cut_line() { cut_ = true; }
  std::size_t capacity() const { return buffer_.capacity(); }
  std::span<char> space();        // where the next input goes; empty only if next() has not been called
  void added(std::size_t count);  // this many bytes were added there
  void end() { ended_ = true; }   // there will be no more input
  bool ended() const { return ended_; }

  enum class Kind { kLine, kTooLong, kCut, kHalf };
  struct Line {
    Kind kind;
    std::string_view text;  // without LF, and without a CR before it; valid until space() is called
  };
  std::optional<Line> next();
  bool empty() const { return unread() == 0; }  // next() has returned all lines
  std::size_t lines(std::size_t most) const;    // how many whole lines wait, counted up to `most`

 private:
  std::size_t unread() const { return end_ - begin_; }
  void shrink();
  std::size_t grown_size() const;

  std::size_t longest_;
  std::string buffer_;
  std::size_t begin_ = 0, end_ = 0;  // of what next() has not returned
  std::size_t searched_ = 0;         // bytes from begin_ that contain no LF
  bool skipping_ = false;            // within a line that was too long, or cut
  bool cut_ = false;                 // memory did not suffice for the line
  bool ended_ = false;
};

}  // namespace racebeam
