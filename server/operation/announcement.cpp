#include "server/operation/announcement.hpp"

#include <boost/asio/ip/host_name.hpp>
#include <nlohmann/json.hpp>

#include "server/operation/published_file.hpp"

namespace racebeam {
namespace {

constexpr int kFormat = 1;  // of the announce file

std::string as_json(const nlohmann::json& value) {
  return value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace

std::string host_name() {
  boost::system::error_code unknown;
  return boost::asio::ip::host_name(unknown);
}

std::string ready_text(const std::vector<std::string>& addresses) {
  std::string text(kReadyFile.mark);
  for (const std::string& address : addresses) (text += address) += '\n';
  return text;
}

std::string announce_text(const Announcement& announcement) {
  std::string text(kAnnounceFile.mark);
  text.append(" ").append(std::to_string(kFormat)).append(",\n \"addresses\": [");
  const char* separator = "\n  ";
  for (const std::string& address : announcement.addresses) {
    (text += separator) += as_json(address);
    separator = ",\n  ";
  }
  text += "\n ]";
  const auto add = [&](const std::string& key, const nlohmann::json& value) {
    text += ",\n \"" + key + "\": " + as_json(value);
  };
  add("host", announcement.host);
  add("process", announcement.process);
  add("version", announcement.version);
  add("games", announcement.games);
  add("token", announcement.token);
  return text += "}\n";
}

}  // namespace racebeam
