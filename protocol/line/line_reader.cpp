#include "protocol/line/line_reader.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

namespace racebeam {
namespace {

constexpr std::size_t kUsual = 4096;  // the size for an idle session

}  // namespace

LineReader::LineReader(std::size_t longest) : longest_(longest), buffer_(kUsual, '\0') {}

std::span<char> LineReader::space() {
  if (begin_ > 0) {
    std::memmove(buffer_.data(), buffer_.data() + begin_, unread());
    end_ -= begin_;
    begin_ = 0;
  }
  if (end_ == 0) shrink();
  return std::span(buffer_).subspan(end_);
}

void LineReader::grow() { buffer_.resize(grown_size()); }

std::size_t LineReader::grown_size() const {
  return std::min(std::max(kUsual, 2 * unread()), longest_ + kUsual);
}

std::size_t LineReader::growth() const {
  const bool is_full = unread() == buffer_.size();
  return is_full && grown_size() > buffer_.size() ? grown_size() - buffer_.size() : 0;
}

void LineReader::shrink() {
  if (buffer_.size() <= kUsual) return;
  buffer_.resize(kUsual);
  buffer_.shrink_to_fit();
}

void LineReader::added(std::size_t count) { end_ += count; }

std::optional<LineReader::Line> LineReader::next() {
  const std::string_view rest(buffer_.data() + begin_, unread());
  const std::size_t feed = rest.find('\n', searched_);
  if (feed != std::string_view::npos) {
    begin_ += feed + 1;
    searched_ = 0;
    const bool too_long = feed > longest_;
    if (std::exchange(skipping_, false)) return next();
    std::string_view line = rest.substr(0, feed);
    if (line.ends_with('\r')) line.remove_suffix(1);
    return too_long ? Line{Kind::kTooLong, {}} : Line{Kind::kLine, line};
  }
  searched_ = rest.size();
  const bool cut = std::exchange(cut_, false);
  if (skipping_ || cut || rest.size() > longest_) {
    begin_ = end_;
    searched_ = 0;
    if (std::exchange(skipping_, true)) return std::nullopt;
    return Line{cut ? Kind::kCut : Kind::kTooLong, {}};
  }
  if (!ended_ || rest.empty()) return std::nullopt;
  begin_ = end_;
  searched_ = 0;
  return Line{Kind::kHalf, rest};
}

std::size_t LineReader::lines(std::size_t most) const {
  const std::string_view rest(buffer_.data() + begin_, unread());
  std::size_t found = 0;
  for (std::size_t at = rest.find('\n', searched_); at != rest.npos && found < most;
       at = rest.find('\n', at + 1))
    ++found;
  return found;
}

}  // namespace racebeam
