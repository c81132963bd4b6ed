#include "protocol/line/commands/command_table.hpp"

#include <array>

namespace racebeam {

#include "protocol/description/command_rows.inc"

constexpr CommandTable kTable = {kCommands, kAliases};

const CommandTable& command_table() { return kTable; }
std::span<const Command> commands() { return kCommands; }
std::span<const Alias> aliases() { return kAliases; }
const Command& find_command(std::string_view name) { return kTable.find(name); }

}  // namespace racebeam
