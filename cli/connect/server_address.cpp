#include "cli/connect/server_address.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace racebeam {
namespace {

constexpr std::array<std::string_view, 5> kSchemes = {"tcp", "tls", "unix", "pipes", "file"};

bool is_port(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
}

bool is_host(std::string_view text) {
  if (text.starts_with('[') && text.ends_with(']')) return text.find('/') == std::string_view::npos;
  return !text.empty() && text.find_first_of(":/?") == std::string_view::npos &&
         std::ranges::find(kSchemes, text) == kSchemes.end();
}

}  // namespace

std::string server_address(const std::string& text) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string::npos) return text;
  const std::string_view all = text;
  return is_host(all.substr(0, colon)) && is_port(all.substr(colon + 1)) ? "tcp://" + text : text;
}

}  // namespace racebeam
