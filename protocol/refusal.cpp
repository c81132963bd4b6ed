#include "protocol/refusal.hpp"

#include <array>

namespace racebeam {
namespace {

constexpr std::array kCodes = {
    CodeRow{Code::kBadLine, "bad-line", "the line is empty, or has a byte that is not printable ASCII"},
    CodeRow{Code::kLineTooLong, "line-too-long", "the line is longer than `hello` allows"},
    CodeRow{Code::kHalfLine, "half-line", "the input ended within a line, which was not carried out"},
    CodeRow{Code::kUnknownCommand, "unknown-command", "there is no such command"},
    CodeRow{Code::kBadArguments, "bad-arguments", "too few, too many, or no such key or field"},
    CodeRow{Code::kBadValue, "bad-value", "a number or a word is none of those accepted"},
    CodeRow{Code::kBadAction, "bad-action", "there is no such action, or not in the set that was loaded"},
    CodeRow{Code::kUnknownGame, "unknown-game", "no image of that name or MD5 is at hand"},
    CodeRow{Code::kBadImage, "bad-image", "the bytes that were sent are no cartridge image"},
    CodeRow{Code::kNoGame, "no-game", "the command needs a game: `load` first"},
    CodeRow{Code::kNoMachines, "no-machines", "the command needs machines: `open` first"},
    CodeRow{Code::kNoState, "no-state", "no state of that name was saved"},
    CodeRow{Code::kBadState, "bad-state", "what was sent is no state, or not one of this game"},
    CodeRow{Code::kRecording, "recording", "recordings are off, one is running, or the disk refused"},
    CodeRow{Code::kLimit, "limit", "more than `hello` allows"},
    CodeRow{Code::kUnauthorized, "unauthorized", "this server wants a token: `hello token=TOKEN`"},
    CodeRow{Code::kBusy, "busy", "the server has as many sessions as it takes; it closes this one"},
    CodeRow{Code::kIdle, "idle", "nothing came or went for too long; the server closes the session"},
    CodeRow{Code::kStopping, "stopping", "the server is told to stop; it closes the session"},
    CodeRow{Code::kInternal, "internal", "a fault of the server's; the request may be half done"},
};

}  // namespace

std::span<const CodeRow> codes() { return kCodes; }

std::string_view name_of(Code code) { return kCodes[static_cast<std::size_t>(code)].name; }

}  // namespace racebeam
