#include "cli/connect/page_address.hpp"

#include <array>
#include <racebeam/client.hpp>
#include <string_view>
#include <utility>

namespace racebeam {

std::string page_address(const std::string& address) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 4> kSchemes = {{
      {"ws://", "http://"},
      {"wss://", "https://"},
      {"http://", "http://"},
      {"https://", "https://"},
  }};
  for (const auto& [from, to] : kSchemes) {
    if (!address.starts_with(from)) continue;
    const std::string place = address.substr(from.size());
    return std::string(to).append(place.substr(0, place.find('/')));
  }
  return {};
}

std::string announced_page(const std::string& path, std::string& token) {
  const client::detail::ServerFile file(path);
  token = file.token;
  for (const std::string& address : file.addresses) {
    if (const std::string page = page_address(address); !page.empty()) return page;
  }
  return {};
}

}  // namespace racebeam
