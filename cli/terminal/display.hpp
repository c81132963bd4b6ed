// Moving pictures in the terminal, and its keys.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "cli/terminal/graphics.hpp"
#include "cli/terminal/input.hpp"
#include "system/program/tty.hpp"

namespace racebeam {

// What a terminal has said about itself.
struct TerminalAbilities {
  bool answers = false;  // anything at all, in time
  bool sixel = false, kitty = false;
  bool keyboard = false;  // it tells when keys are released
};

// Asks the terminal, and waits for half a second at most.
TerminalAbilities ask_abilities(Tty& tty);

// The form that `preference` leads to.
Graphics choose_graphics(Graphics preference, const TerminalAbilities& abilities);

// Takes the whole terminal for its lifetime. Pictures that the line does not carry in time are to be left
// out: the terminal says which have arrived, and at most two are under way.
class Display {
 public:
  using Time = Tty::Time;

  explicit Display(Graphics preference);
  ~Display();  // the terminal is as before
  Display(const Display&) = delete;
  Display& operator=(const Display&) = delete;

  bool tells_releases() const { return abilities_.keyboard; }

  // Whether the terminal takes another picture now.
  bool is_ready();

  // Whether the terminal has another size than the last time that something was shown. The picture is then
  // needed again, even if it is the same.
  bool is_resized() const;

  // May only be called when it is_ready(). `line` stands below the picture. Without a picture, only the line
  // is drawn; in a terminal that is_resized(), nothing else is then left.
  void show(const TerminalPicture* picture, const std::string& line);

  // Waits until keys come, the terminal becomes ready, or the time has come. Returns keys. Ends the process
  // as Ctrl-C does, if that is pressed.
  std::vector<TerminalEvent> wait(Time until);

 private:
  Tty tty_;
  TerminalAbilities abilities_;
  Painter painter_;
  InputParser parser_;
  Room room_{.columns = 0, .rows = 0};  // for which the picture was drawn
  int under_way_ = 0;                   // pictures whose arrival the terminal has not confirmed
  Time last_time_{};                    // when the last one was written
};

}  // namespace racebeam
