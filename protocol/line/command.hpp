// What a session knows of its commands: the shape of a row, and how one is found and checked. Whoever makes a session
// gives it the table (commands/command_table.cpp).
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "protocol/line/words.hpp"

namespace racebeam {

class Session;

enum class Needs { kNothing, kAdmission, kGame, kMachines };  // each includes those before it

struct Command {
  std::string_view name;
  std::string_view arguments;  // as `help` and protocol/PROTOCOL.md show them
  std::string_view summary;
  std::string_view hint;     // for `help`: where a person finds the words that it takes; may be empty
  std::string_view example;  // the same: one that works; empty: it is clear without
  std::size_t least, most;   // arguments
  Needs needs;

  // Appends "ok" and what follows to session.out, without LF. Throws Refusal. Runs as the body of session.pacer: what takes
  // long is suspended between frames, or where it calls breathe().
  void (*run)(Session& session, Words arguments);
};

constexpr std::size_t kAnyNumber = static_cast<std::size_t>(-1);

struct Alias {  // what people try
  std::string_view name, command;
};

struct CommandTable {
  std::span<const Command> commands;
  std::span<const Alias> aliases;

  // By its name or an alias. Throws Refusal, with the names that there are.
  const Command& find(std::string_view name) const;
  std::size_t row(const Command& command) const { return static_cast<std::size_t>(&command - commands.data()); }
};

// Throws Refusal when the number of arguments is wrong, or when something else has to come first.
void check(const Command& command, const Session& session, std::size_t arguments);

std::string usage(const Command& command);  // its name and arguments

}  // namespace racebeam
