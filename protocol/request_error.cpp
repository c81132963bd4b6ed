#include "protocol/request_error.hpp"

#include <array>

namespace racebeam {
namespace {

constexpr std::array kCodes = {
    CodeRow{Code::kBadLine, "bad-line", "the line is empty, or has a byte that is not printable ASCII"},
    CodeRow{Code::kLineTooLong, "line-too-long", "the line is longer than `hello` allows"},
    CodeRow{Code::kHalfLine, "half-line", "the input ended within a line, which was not executed"},
    CodeRow{Code::kUnknownCommand, "unknown-command", "there is no such command"},
    CodeRow{Code::kBadArguments, "bad-arguments", "too few, too many, or no such key or field"},
    CodeRow{Code::kBadValue, "bad-value", "a number or a word is not accepted"},
    CodeRow{Code::kBadAction, "bad-action",
            "there is no such action, or it is not in the set that was loaded"},
    CodeRow{Code::kUnknownGame, "unknown-game", "there is no image of that name or MD5"},
    CodeRow{Code::kBadImage, "bad-image", "the bytes that were sent are not a cartridge image"},
    CodeRow{Code::kNoGame, "no-game", "the command needs a game: `load` first"},
    CodeRow{Code::kNoMachines, "no-machines", "the command needs machines: `open` first"},
    CodeRow{Code::kNoState, "no-state", "no state of that name was saved"},
    CodeRow{Code::kBadState, "bad-state", "the bytes that were sent are not a state of this game"},
    CodeRow{Code::kRecording, "recording",
            "recordings are off, one is running, or the files cannot be written"},
    CodeRow{Code::kLimit, "limit", "more than `hello` allows"},
    CodeRow{Code::kUnauthorized, "unauthorized", "this server requires a token: `hello token=TOKEN`"},
    CodeRow{Code::kBusy, "busy", "the server has reached its limit of sessions; it closes this one"},
    CodeRow{Code::kIdle, "idle", "nothing was received or sent for too long; the server closes the session"},
    CodeRow{Code::kStopping, "stopping", "the server is stopping; it closes the session"},
    CodeRow{Code::kInternal, "internal",
            "an internal error of the server; the request may be partly executed"},
};

}  // namespace

std::span<const CodeRow> codes() { return kCodes; }

std::string_view name_of(Code code) { return kCodes[static_cast<std::size_t>(code)].name; }

}  // namespace racebeam
