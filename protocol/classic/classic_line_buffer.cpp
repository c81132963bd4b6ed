#include "protocol/classic/classic_line_buffer.hpp"

#include <cstring>

namespace racebeam {

std::span<char> LineBuffer::space() {
  std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
  end_ -= begin_;
  begin_ = 0;
  return std::span(buffer_).subspan(end_);
}

void LineBuffer::added(std::size_t count) { end_ += count; }

std::optional<std::string_view> LineBuffer::line(std::size_t longest) {
  const std::string_view text = rest().substr(0, longest);
  const std::size_t feed = text.find('\n');
  if (feed != std::string_view::npos) {
    begin_ += feed + 1;
    return text.substr(0, feed);
  }
  if (text.size() < longest) return std::nullopt;
  begin_ += longest;
  return text;
}

}  // namespace racebeam
