// racebeam roms: lists which images in a folder are known.
#pragma once

namespace racebeam {

class Subcommand;

void add_roms(Subcommand& program);

}  // namespace racebeam
