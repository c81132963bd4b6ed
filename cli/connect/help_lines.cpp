#include "cli/connect/help_lines.hpp"

#include <algorithm>
#include <vector>

#include "system/folded.hpp"
#include "system/program/standard_streams.hpp"

namespace racebeam {
namespace {

constexpr std::size_t kUsualColumns = 80, kNarrowest = 20, kIndent = 2, kHanging = 6;

// Whether a row of a list begins here: "NAME: ...", "NAME (ACCEPTED): ..." or "NAME (SOURCE) sets ...".
bool is_entry(std::string_view text) {
  constexpr std::string_view kNameSigns =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-.=";
  if (text.starts_with("help ") || text.starts_with("more with ")) return true;
  const std::size_t name = std::min(text.find_first_not_of(kNameSigns), text.size());
  if (name == 0) return false;
  text.remove_prefix(name);
  if (text.starts_with(" (")) text.remove_prefix(std::min(text.find(')'), text.size() - 1) + 1);
  return text.starts_with(": ") || text.starts_with(" sets ");
}

// The head, and the entries that follow it.
std::vector<std::string_view> parts_of(std::string_view text) {
  std::vector<std::string_view> parts;
  std::size_t begin = 0;
  for (std::size_t at = 0; at + 2 < text.size(); ++at) {
    const bool ends_head = parts.empty() && text.substr(at, 2) == ": ",
               ends_entry = text.substr(at, 2) == "; ";
    if ((!ends_head && !ends_entry) || !is_entry(text.substr(at + 2))) continue;
    parts.push_back(text.substr(begin, at + (ends_head ? 1 : 0) - begin));
    begin = at + 2;
  }
  parts.push_back(text.substr(begin));
  return parts;
}

}  // namespace

std::string help_lines(std::string_view reply, std::size_t columns) {
  columns = std::max(columns, kNarrowest);
  std::string lines;
  for (const std::string_view part : parts_of(reply)) {
    const std::size_t indent = lines.empty() ? 0 : kIndent;
    if (!lines.empty()) (lines += '\n').append(indent, ' ');
    append_folded(lines, part, columns, indent, kHanging);
  }
  return lines;
}

std::size_t columns_of_output() {
  const int columns = terminal_columns(kStandardOutput);
  return columns > 0 ? static_cast<std::size_t>(columns) : kUsualColumns;
}

}  // namespace racebeam
