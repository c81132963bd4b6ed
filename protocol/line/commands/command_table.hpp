// The commands of the line protocol: one table, from which they are found, checked, explained and, by a test,
// compared with protocol/PROTOCOL.md.
#pragma once

#include <span>
#include <string_view>

#include "protocol/line/command.hpp"

namespace racebeam {

const CommandTable& command_table();

// Its parts.
std::span<const Command> commands();
std::span<const Alias> aliases();
const Command& find_command(std::string_view name);  // or an alias; throws Refusal

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
