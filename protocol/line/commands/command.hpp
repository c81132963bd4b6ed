// The commands of the line protocol: one table, from which they are found, checked, explained and, by a test,
// compared with protocol/PROTOCOL.md.
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

std::span<const Command> commands();

struct Alias {  // what people try
  std::string_view name, command;
};
std::span<const Alias> aliases();

// By its name or an alias. Throws Refusal, with the names that there are.
const Command& find_command(std::string_view name);

// Throws Refusal when the number of arguments is wrong, or when something else has to come first.
void check(const Command& command, const Session& session, std::size_t arguments);

std::string usage(const Command& command);  // its name and arguments

constexpr std::size_t kAnyNumber = static_cast<std::size_t>(-1);

// command_session.cpp
void run_hello(Session&, Words);
void run_help(Session&, Words);
void run_stats(Session&, Words);
void run_quit(Session&, Words);

// command_load.cpp
void run_games(Session&, Words);
void run_load(Session&, Words);
void run_settings(Session&, Words);
void run_set(Session&, Words);
void run_modes(Session&, Words);
void run_difficulties(Session&, Words);
void run_actions(Session&, Words);

// command_play.cpp
void run_observe(Session&, Words);
void run_look(Session&, Words);
void run_act(Session&, Words);
void run_reset(Session&, Words);
void run_peek(Session&, Words);
void run_poke(Session&, Words);

// command_state.cpp
void run_save(Session&, Words);
void run_restore(Session&, Words);
void run_drop(Session&, Words);
void run_states(Session&, Words);
void run_export(Session&, Words);
void run_import(Session&, Words);
void run_branch(Session&, Words);

// command_machines.cpp
void run_open(Session&, Words);
void run_step(Session&, Words);
void run_restart(Session&, Words);
void run_close(Session&, Words);

// command_record.cpp
void run_record(Session&, Words);

}  // namespace racebeam
