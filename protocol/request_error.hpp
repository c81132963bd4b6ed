// The errors of the line protocol: `error CODE sentence`. protocol/protocol.toml lists the codes.
#pragma once

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "protocol/description/error_code.hpp"

namespace racebeam {

struct ErrorRow {
  std::string_view name;
  std::string_view meaning;
};

std::span<const ErrorRow> codes();  // in the order of ErrorCode
std::string_view name_of(ErrorCode code);

// Ends a request with an error; the session continues.
class RequestError : public std::runtime_error {
 public:
  RequestError(ErrorCode code, const std::string& sentence) : std::runtime_error(sentence), code_(code) {}
  ErrorCode code() const { return code_; }

 private:
  ErrorCode code_;
};

}  // namespace racebeam
