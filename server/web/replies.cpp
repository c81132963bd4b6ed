#include "server/web/replies.hpp"

#include <charconv>

namespace racebeam {
namespace {

// N of a reply that ends with raw=N; 0 for others.
std::size_t raw_size(std::string_view line) {
  constexpr std::string_view kRaw = " raw=";
  const std::size_t last = line.rfind(' ');
  if (!line.starts_with("ok ") || !line.substr(last).starts_with(kRaw)) return 0;
  std::size_t size = 0;
  std::from_chars(line.data() + last + kRaw.size(), line.data() + line.size(), size);
  return size;
}

}  // namespace

CutReply cut_reply(std::string_view& output) {
  const std::string_view line = output.substr(0, output.find('\n'));
  output.remove_prefix(line.size() + 1);
  const std::string_view raw = output.substr(0, raw_size(line));
  output.remove_prefix(raw.size());
  return {line, raw};
}

}  // namespace racebeam
