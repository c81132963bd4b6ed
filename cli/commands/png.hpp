// racebeam png: converts a screen, as a client received it, to a picture.
#pragma once

namespace CLI {
class App;
}

namespace racebeam {

void add_png(CLI::App& app);

}  // namespace racebeam
