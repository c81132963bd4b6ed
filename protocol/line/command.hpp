// The commands of a session: the format of a row, and functions that find and check one. LineSession supplies
// the table (commands/command_table.cpp).
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "system/words.hpp"

namespace racebeam {

class Context;
class Reply;

enum class Needs { kNothing, kAdmission, kGame, kMachines };  // each includes those before it

struct Command {
  std::string_view name;
  std::string_view arguments;  // as in `help` and protocol/PROTOCOL.md
  std::string_view summary;
  std::string_view hint;     // for `help`: where to find the accepted words; may be empty
  std::string_view example;  // for `help`: a working example; empty: none is needed
  std::size_t least, most;   // number of arguments
  Needs needs;
  bool takes_fields;
  bool has_old;  // old words among its arguments (old_words.hpp)

  // Writes the reply, which begins with "ok". Throws RequestError. It runs as the body of context.pacer: long
  // work is suspended between frames, or where it calls yield_if_due().
  void (*run)(Context& context, Words arguments, Reply& reply);

  // The keys of replies: "KEY:TYPE KEY?:TYPE", where ? marks an optional key.
  std::string_view reply, groups;
  std::string_view shows;   // where the fields are: "first", "groups", "asked" or ""
  std::string_view echoes;  // the table whose names are keys, too
};

constexpr std::size_t kAnyNumber = static_cast<std::size_t>(-1);

struct Alias {  // other names that people try
  std::string_view name, command;
};

struct CommandTable {
  std::span<const Command> commands;
  std::span<const Alias> aliases;

  const Command* look_up(std::string_view name) const;  // by its name or an alias; null: unknown
  // Returns the command of this name or alias. Throws RequestError, with the names that exist.
  const Command& find(std::string_view name) const;
  std::size_t row(const Command& command) const {
    return static_cast<std::size_t>(&command - commands.data());
  }
};

// Throws RequestError: the client must give a token before it asks for `name`.
[[noreturn]] void refuse_without_token(std::string_view name);

// Throws RequestError if the number of arguments is wrong, or another command must come first.
void check(const Command& command, const Context& context, std::size_t arguments);

std::string usage(const Command& command);  // its name and arguments

}  // namespace racebeam
