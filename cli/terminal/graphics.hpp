// The forms in which a terminal shows pictures.
#pragma once

#include <string>

#include "cli/terminal/half_blocks.hpp"
#include "cli/terminal/picture.hpp"

namespace racebeam {

class Option;
class Subcommand;

enum class Graphics { kAuto, kBlocks, kSixel, kKitty };  // kAuto: the best that the terminal says it has

void add_graphics_option(Subcommand& command, Graphics& graphics);  // --graphics

// A picture at the cursor, among text.
std::string inline_picture(Graphics graphics, const TerminalPicture& picture, const Room& room);

// Pictures that follow each other in the upper left corner. `graphics` is not kAuto.
class Painter {
 public:
  explicit Painter(Graphics graphics) : graphics_(graphics) {}

  std::string paint(const TerminalPicture& picture, const Room& room);
  void forget() { last_cells_ = {}; }  // the terminal was cleared

 private:
  Graphics graphics_;
  Cells last_cells_;  // as blocks
};

}  // namespace racebeam
