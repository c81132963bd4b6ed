#include "cli/terminal/input.hpp"

#include <charconv>
#include <optional>

namespace racebeam {
namespace {

using Kind = TerminalEvent::Kind;

constexpr std::size_t kLongest = 512;  // bytes of a sequence; a longer one has lost its end
constexpr char kEscape = '\x1b', kInterrupt = '\x03';
constexpr std::string_view kArrows = "ABCD";  // in the order of the key codes

// The first number of a text, or 0.
int number(std::string_view text) {
  int value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

// A part of a text between separators; empty if there are fewer.
std::string_view part(std::string_view text, char separator, std::size_t index) {
  for (; index > 0; --index) {
    const std::size_t end = text.find(separator);
    if (end == text.npos) return {};
    text.remove_prefix(end + 1);
  }
  return text.substr(0, text.find(separator));
}

int lower(int character) {
  return character >= 'A' && character <= 'Z' ? character + ('a' - 'A') : character;
}

// A key of the keyboard protocol of kitty: CSI code:... ; modifiers:event ; ... u
TerminalEvent key_of(int key, std::string_view parameters) {
  constexpr int kControl = 4, kReleased = 3;
  const std::string_view second = part(parameters, ';', 1);
  const int modifiers = number(part(second, ':', 0)) - 1;
  if (key == 'c' && modifiers > 0 && (modifiers & kControl) != 0) key = kKeyInterrupt;
  return {number(part(second, ':', 1)) == kReleased ? Kind::kRelease : Kind::kPress, key};
}

std::optional<TerminalEvent> control_sequence(std::string_view parameters, char end) {
  const bool is_private = parameters.starts_with('?');
  if (const std::size_t arrow = kArrows.find(end); arrow != kArrows.npos)
    return key_of(kKeyUp + static_cast<int>(arrow), parameters);
  if (end == 'u' && is_private) return TerminalEvent{Kind::kKeyboard};
  if (end == 'u') return key_of(lower(number(parameters)), parameters);
  if (end == 'n') return TerminalEvent{Kind::kArrived};
  if (end == 'c' && is_private) return TerminalEvent{Kind::kAttributes, 0, std::string(parameters.substr(1))};
  return std::nullopt;
}

// A sequence from the front of the input.
struct Taken {
  std::size_t size = 0;  // 0: its end has not come
  std::optional<TerminalEvent> event = std::nullopt;
};

Taken take_control_sequence(std::string_view bytes) {
  const std::size_t end = bytes.find_first_not_of("0123456789:;<=>? !\"#$%&'()*+,-./", 2);
  if (end == bytes.npos) return {};
  return {end + 1, control_sequence(bytes.substr(2, end - 2), bytes[end])};
}

// ESC _ text ESC backslash
Taken take_string(std::string_view bytes) {
  const std::size_t end = bytes.find("\x1b\\");
  if (end == bytes.npos) return {};
  const std::string_view text = bytes.substr(2, end - 2);
  if (bytes[1] != '_' || !text.starts_with("Gi=31")) return {end + 2};
  return {end + 2, TerminalEvent{Kind::kGraphics, 0, std::string(part(text, ';', 1))}};
}

Taken take_escape(std::string_view bytes) {
  if (bytes.size() < 2) return {};
  switch (bytes[1]) {
    case '[': return take_control_sequence(bytes);
    case 'O':  // an arrow in the application mode
      if (bytes.size() < 3) return {};
      return {3, control_sequence({}, bytes[2])};
    case '_':
    case ']':
    case 'P': return take_string(bytes);
    default: return {1};  // the key Escape
  }
}

Taken take(std::string_view bytes) {
  if (bytes[0] == kEscape) return take_escape(bytes);
  if (bytes[0] == kInterrupt) return {1, TerminalEvent{Kind::kPress, kKeyInterrupt}};
  return {1, TerminalEvent{Kind::kPress, lower(static_cast<unsigned char>(bytes[0]))}};
}

}  // namespace

std::vector<TerminalEvent> InputParser::parse(std::string_view bytes) {
  rest_.append(bytes);
  std::vector<TerminalEvent> events;
  std::size_t at = 0;
  while (at < rest_.size()) {
    Taken part = take(std::string_view(rest_).substr(at));
    if (part.size == 0 && rest_.size() - at > kLongest) part.size = 1;
    if (part.size == 0) break;
    if (part.event) events.push_back(*std::move(part.event));
    at += part.size;
  }
  rest_.erase(0, at);
  return events;
}

}  // namespace racebeam
