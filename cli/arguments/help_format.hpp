// The form of the help texts: at most 100 columns, whatever the width of their sources.
#pragma once

namespace CLI {
class App;
}

namespace racebeam {

// Gives this form to the help texts of `app`, and of subcommands that are added to it afterwards.
void set_help_format(CLI::App& app);

}  // namespace racebeam
