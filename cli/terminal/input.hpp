// What a terminal sends: keys, and answers to what it was asked.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace racebeam {

// Keys are lower case characters, or these:
enum KeyCode : int { kKeyUp = 0x100, kKeyDown, kKeyRight, kKeyLeft, kKeyInterrupt };

struct TerminalEvent {
  enum class Kind {
    kPress,       // of a key, or its repetition
    kRelease,     // only in the keyboard protocol of kitty
    kArrived,     // the answer to kAskArrival
    kAttributes,  // the answer to kAskAttributes; `text`: numbers, separated by semicolons
    kKeyboard,    // the terminal has the keyboard protocol of kitty: the answer to kAskKeyboard
    kGraphics     // the answer to kAskGraphics; `text`: "OK" if it has the graphics protocol of kitty
  };
  Kind kind;
  int key = 0;
  std::string text = {};
};

constexpr std::string_view kAskArrival = "\x1b[5n";    // device status
constexpr std::string_view kAskAttributes = "\x1b[c";  // every terminal answers it
constexpr std::string_view kAskKeyboard = "\x1b[?u";
constexpr std::string_view kAskGraphics = "\x1b_Gi=31,s=1,v=1,a=q,t=d,f=24;AAAA\x1b\\";

class InputParser {
 public:
  // The bytes may begin and end anywhere. What is not known is left out.
  std::vector<TerminalEvent> parse(std::string_view bytes);

 private:
  std::string rest_;  // the beginning of a sequence
};

}  // namespace racebeam
