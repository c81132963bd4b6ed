#include "cli/terminal/display.hpp"

#include <csignal>

namespace racebeam {
namespace {

using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;
using Kind = TerminalEvent::Kind;

constexpr auto kAnswerTimeout = 500ms;  // for answers
constexpr auto kLost = 2s;              // an answer that has not come by then does not come
constexpr auto kUnanswered = 33ms;      // between pictures for a terminal that does not answer
constexpr int kMaxUnderWay = 2;

constexpr std::string_view kEnter = "\x1b[?1049h\x1b[?25l\x1b[2J", kLeave = "\x1b[0m\x1b[?25h\x1b[?1049l";
// The terminal reports each key, when it is pressed and when it is released.
constexpr std::string_view kReleases = "\x1b[>11u", kNoReleases = "\x1b[<u";
constexpr std::string_view kDeletePictures = "\x1b_Ga=d,d=A,q=2\x1b\\";
// The terminal shows what is between the two at once, if it knows them. kEndOfAny ends what a signal cut off.
constexpr std::string_view kBegin = "\x1b[?2026h", kEnd = "\x1b[?2026l", kEndOfAny = "\x1b\\\x1b[?2026l";
constexpr std::string_view kClear = "\x1b[2J", kToEndOfLine = "\x1b[K";

// Whether a list of numbers, separated by semicolons, has 4: sixel graphics.
bool lists_sixel(const std::string& attributes) {
  return (";" + attributes + ";").find(";4;") != std::string::npos;
}

void note(TerminalAbilities& abilities, const TerminalEvent& event) {
  switch (event.kind) {
    case Kind::kKeyboard: abilities.keyboard = true; break;
    case Kind::kGraphics: abilities.kitty = event.text == "OK"; break;
    case Kind::kAttributes:
      abilities.sixel = lists_sixel(event.text);
      abilities.answers = true;
      break;
    default: break;
  }
}

// Whether two terminals have another size, in cells.
bool differ(const Room& a, const Room& b) { return a.columns != b.columns || a.rows != b.rows; }

}  // namespace

// The attributes are asked for last, since all terminals answer that, in the order of the questions.
TerminalAbilities ask_abilities(Tty& tty) {
  TerminalAbilities abilities;
  InputParser parser;
  tty.write(kAskGraphics);
  tty.write(kAskKeyboard);
  tty.write(kAskAttributes);
  for (const auto end = Clock::now() + kAnswerTimeout; !abilities.answers && Clock::now() < end;)
    for (const TerminalEvent& event : parser.parse(tty.wait(end))) note(abilities, event);
  return abilities;
}

Graphics choose_graphics(Graphics preference, const TerminalAbilities& abilities) {
  if (preference != Graphics::kAuto) return preference;
  if (abilities.kitty) return Graphics::kKitty;
  return abilities.sixel ? Graphics::kSixel : Graphics::kBlocks;
}

Display::Display(Graphics preference)
    : abilities_(ask_abilities(tty_)), painter_(choose_graphics(preference, abilities_)) {
  tty_.change(kEnter, kLeave);
  if (abilities_.keyboard) tty_.change(kReleases, kNoReleases);
  if (choose_graphics(preference, abilities_) == Graphics::kKitty) tty_.change({}, kDeletePictures);
  tty_.change({}, kEndOfAny);
}

// Answers that come later would be read by the next program.
Display::~Display() {
  try {
    while (under_way_ > 0 && Clock::now() < last_time_ + kAnswerTimeout) wait(last_time_ + kAnswerTimeout);
  } catch (const std::exception&) {  // the terminal is gone
  }
}

bool Display::is_ready() {
  const auto now = Clock::now();
  if (now > last_time_ + kLost) under_way_ = 0;
  if (!tty_.is_idle()) return false;
  return abilities_.answers ? under_way_ < kMaxUnderWay : now >= last_time_ + kUnanswered;
}

bool Display::is_resized() const { return differ(tty_.size(), room_); }

void Display::show(const TerminalPicture* picture, const std::string& line) {
  Room room = tty_.size();
  std::string text(kBegin);
  if (differ(room, room_)) {
    text.append(kClear);
    painter_.forget();
    room_ = room;
  }
  const std::size_t lines = room.rows;
  if (room.rows > 1) --room.rows;  // the last line is for text
  if (picture != nullptr) text.append(painter_.paint(*picture, room));
  text.append("\x1b[").append(std::to_string(lines)).append(";1H");
  text.append(line.substr(0, room.columns)).append(kToEndOfLine).append(kEnd);
  if (abilities_.answers) {
    text.append(kAskArrival);
    ++under_way_;
  }
  last_time_ = Clock::now();
  tty_.write(text);
}

std::vector<TerminalEvent> Display::wait(Time until) {
  std::vector<TerminalEvent> keys;
  for (TerminalEvent& event : parser_.parse(tty_.wait(until, true))) {
    if (event.key == kKeyInterrupt) std::raise(SIGINT);
    if (event.kind == Kind::kArrived && under_way_ > 0) --under_way_;
    if (event.kind == Kind::kPress || event.kind == Kind::kRelease) keys.push_back(std::move(event));
  }
  return keys;
}

}  // namespace racebeam
