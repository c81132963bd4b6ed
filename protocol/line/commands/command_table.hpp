// The commands of the line protocol: one table, from which they are found, checked and explained. It is made
// from protocol/protocol.toml.
#pragma once

#include <span>
#include <string_view>

#include "protocol/line/command.hpp"

namespace racebeam {

const CommandTable& command_table();

// Its parts.
std::span<const Command> commands();
std::span<const Alias> aliases();
const Command& find_command(std::string_view name);  // or an alias; throws RequestError

}  // namespace racebeam
