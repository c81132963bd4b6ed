// racebeam roms: lists which images in a folder are known.
#pragma once

namespace CLI {
class App;
}

namespace racebeam {

void add_roms(CLI::App& app);

}  // namespace racebeam
