// The errors of the line protocol: `error CODE sentence`. protocol/PROTOCOL.md lists the codes; a test
// compares.
#pragma once

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace racebeam {

enum class Code {
  kBadLine,
  kLineTooLong,
  kHalfLine,
  kUnknownCommand,
  kBadArguments,
  kBadValue,
  kBadAction,
  kUnknownGame,
  kBadImage,
  kNoGame,
  kNoMachines,
  kNoState,
  kBadState,
  kRecording,
  kLimit,
  kUnauthorized,
  kBusy,
  kIdle,
  kStopping,
  kInternal,
};

struct CodeRow {
  Code code;
  std::string_view name;
  std::string_view meaning;
};

std::span<const CodeRow> codes();  // in the order of Code
std::string_view name_of(Code code);

// Ends a request with an error; the session continues.
class Refusal : public std::runtime_error {
 public:
  Refusal(Code code, const std::string& sentence) : std::runtime_error(sentence), code_(code) {}
  Code code() const { return code_; }

 private:
  Code code_;
};

}  // namespace racebeam
