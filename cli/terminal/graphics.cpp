#include "cli/terminal/graphics.hpp"

#include "cli/arguments/subcommand.hpp"
#include "cli/terminal/kitty.hpp"
#include "cli/terminal/sixel.hpp"

namespace racebeam {

void add_graphics_option(Subcommand& command, Graphics& graphics) {
  command.choice<Graphics>(
      "--graphics", graphics,
      {{"auto", Graphics::kAuto},
       {"blocks", Graphics::kBlocks},
       {"sixel", Graphics::kSixel},
       {"kitty", Graphics::kKitty}},
      "auto",
      "How pictures are drawn in the terminal: auto, blocks, sixel or kitty. blocks are characters in 24-bit "
      "colours; auto is the best form that the terminal reports");
}

std::string inline_picture(Graphics graphics, const TerminalPicture& picture, const Room& room) {
  switch (graphics) {
    case Graphics::kKitty: return kitty_picture(picture, room, false) + "\n";
    case Graphics::kSixel: return sixel(picture, room) + "\n";
    default: return as_lines(cells_of(picture, room));
  }
}

std::string Painter::paint(const TerminalPicture& picture, const Room& room) {
  constexpr auto kHome = "\x1b[H";
  switch (graphics_) {
    case Graphics::kKitty: return kHome + kitty_picture(picture, room, true);
    case Graphics::kSixel: return kHome + sixel(picture, room);
    default: {
      Cells now = cells_of(picture, room);
      std::string text = as_changes(last_cells_, now);
      last_cells_ = std::move(now);
      return text;
    }
  }
}

}  // namespace racebeam
