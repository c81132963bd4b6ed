// Made from protocol/protocol.toml by protocol/description/generate. Do not change it by hand.
// clang-format off
#pragma once

namespace racebeam {

enum class ErrorCode {
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
  kNoLog,
  kLimit,
  kUnauthorized,
  kBusy,
  kIdle,
  kStopping,
  kInternal,
};

}  // namespace racebeam
