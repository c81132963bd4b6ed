// The options of every subcommand with a machine, and the machine that they describe.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "cli/arguments/subcommand.hpp"
#include "environment/environment.hpp"
#include "games/catalogue.hpp"

namespace racebeam {

constexpr int kExitFailure = 1;  // a failure of the command
constexpr int kExitUsage = 2;    // a usage error

struct MachineOptions {
  std::string rom;                       // a file, or builtin:NAME
  std::optional<std::string> game;       // the rule to use, by name
  std::optional<std::string> game_file;  // the rule to use, from the user's file
  Settings settings;
  PropertyOverrides console;
  std::optional<int> mode, difficulty;  // the game's defaults if not given
};

// Adds --rom --game --game-file --scheme --left --right --format --ystart --height --seed --system-seed
// --frame-skip --sticky --color-averaging --rules --cpu
// --mode --difficulty. Set `options` to the subcommand's defaults first; it must outlive the parsing.
void add_machine_options(Subcommand& command, MachineOptions& options);

// Adds --cpu. `cpu` must outlive the parsing.
void add_cpu_option(Subcommand& command, CpuKind& cpu);

// Adds a whole number of at least `least`, such as a number of frames.
Option add_count(Subcommand& command, const std::string& name, int& value, int least,
                 const std::string& help);

using Tell = std::function<void(const std::string& sentence)>;
void tell_on_standard_error(const std::string& sentence);

// Loads the image, recognises the game, and checks that a machine runs with them. Then `tell` gets the
// warnings about the game.
Cartridge open_cartridge(const MachineOptions& options, const Tell& tell = tell_on_standard_error);

// A machine that is switched on, in the mode and difficulty of the options.
Environment power_on(const Cartridge& cartridge, const MachineOptions& options, Pace* pace = nullptr);

Environment open_environment(const MachineOptions& options);

// Returns the seed, or, for 0, a seed from the clock, which is never 0.
std::uint32_t resolve_seed(std::uint32_t seed);

}  // namespace racebeam
