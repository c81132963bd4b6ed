#include "protocol/request_error.hpp"

#include <array>

namespace racebeam {
namespace {

constexpr std::array kCodes = {
    ErrorRow{ErrorCode::kBadLine, "bad-line", "the line is empty, or has a byte that is not printable ASCII"},
    ErrorRow{ErrorCode::kLineTooLong, "line-too-long", "the line is longer than `hello` allows"},
    ErrorRow{ErrorCode::kHalfLine, "half-line", "the input ended within a line, which was not executed"},
    ErrorRow{ErrorCode::kUnknownCommand, "unknown-command", "there is no such command"},
    ErrorRow{ErrorCode::kBadArguments, "bad-arguments", "too few, too many, or no such key or field"},
    ErrorRow{ErrorCode::kBadValue, "bad-value", "a number or a word is not accepted"},
    ErrorRow{ErrorCode::kBadAction, "bad-action",
             "there is no such action, or it is not in the set that was loaded"},
    ErrorRow{ErrorCode::kUnknownGame, "unknown-game", "there is no image of that name or MD5"},
    ErrorRow{ErrorCode::kBadImage, "bad-image", "the bytes that were sent are not a cartridge image"},
    ErrorRow{ErrorCode::kNoGame, "no-game", "the command needs a game: `load` first"},
    ErrorRow{ErrorCode::kNoMachines, "no-machines", "the command needs machines: `open` first"},
    ErrorRow{ErrorCode::kNoState, "no-state", "no state of that name was saved"},
    ErrorRow{ErrorCode::kBadState, "bad-state", "the bytes that were sent are not a state of this game"},
    ErrorRow{ErrorCode::kRecording, "recording",
             "recordings are off, one is running, or the files cannot be written"},
    ErrorRow{ErrorCode::kLimit, "limit", "more than `hello` allows"},
    ErrorRow{ErrorCode::kUnauthorized, "unauthorized", "this server requires a token: `hello token=TOKEN`"},
    ErrorRow{ErrorCode::kBusy, "busy", "the server has reached its limit of sessions; it closes this one"},
    ErrorRow{ErrorCode::kIdle, "idle",
             "nothing was received or sent for too long; the server closes the session"},
    ErrorRow{ErrorCode::kStopping, "stopping", "the server is stopping; it closes the session"},
    ErrorRow{ErrorCode::kInternal, "internal",
             "an internal error of the server; the request may be partly executed"},
};

}  // namespace

std::span<const ErrorRow> codes() { return kCodes; }

std::string_view name_of(ErrorCode code) { return kCodes[static_cast<std::size_t>(code)].name; }

}  // namespace racebeam
