/// @file
/// The exceptions of the client. They are values, so that any thread may keep one.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "racebeam/client/config.hpp"

namespace RACEBEAM_CLIENT_NAMESPACE {

/// The server refused a request: `error CODE sentence`. The session continues.
class RACEBEAM_CLIENT_API Refused : public std::runtime_error {
 public:
  /// @param code for programs, such as `bad-action`
  /// @param sentence for people
  Refused(std::string code, std::string sentence)
      : std::runtime_error(std::string(code).append(": ").append(sentence)),
        code_(std::move(code)),
        sentence_(std::move(sentence)) {}

  /// The error code, as protocol/PROTOCOL.md lists it.
  const std::string& code() const noexcept { return code_; }
  /// What the server says to people.
  const std::string& sentence() const noexcept { return sentence_; }

 private:
  std::string code_, sentence_;
};

/// The server is not there, has gone, or sent an invalid reply. The session has ended.
class RACEBEAM_CLIENT_API Lost : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The server did not answer in time. The session has ended.
class RACEBEAM_CLIENT_API TimedOut : public Lost {
 public:
  using Lost::Lost;
};

namespace detail {

/// What a server sent, for people: a terminal would execute some of its bytes. Bytes that are not printable
/// ASCII become \xNN.
inline std::string printable(std::string_view text) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string escaped;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte < 0x7F) {
      escaped += c;
    } else {
      ((escaped += "\\x") += kDigits[byte >> 4U]) += kDigits[byte & 15U];
    }
  }
  return escaped;
}

}  // namespace detail
}  // namespace RACEBEAM_CLIENT_NAMESPACE
