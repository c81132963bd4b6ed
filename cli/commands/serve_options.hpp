// The settings of `racebeam serve`: on the command line, in the environment and in a file.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cli/arguments/options.hpp"
#include "cli/arguments/settings_sources.hpp"
#include "protocol/classic/classic.hpp"
#include "protocol/line_session.hpp"
#include "server/connections/settings.hpp"
#include "server/operation/log.hpp"

namespace racebeam {

struct ServeOptions {
  MachineOptions machine;
  ClassicOptions protocol;
  LineLimits limits;
  ServerSettings server;
  bool classic = false, standard_streams = false, full_screen = false, strict = false;
  bool watch_all = false;
  std::string pipes, roms, record_folder;
  std::vector<std::string> addresses;
  LogLevel log_level = LogLevel::kInfo;
  LogFormat log_format = LogFormat::kText;
};

void add_serve_options(Subcommand& command, ServeOptions& options);  // `options` must outlive the parsing

// Puts the options that only the classic protocol uses into a group of the help text; "" hides them.
void group_classic_options(Subcommand& command, const std::string& group);

// Call it after complete(). Computes the endpoints, and checks that all settings fit together. Throws
// UsageError.
void finish(ServeOptions& options, const std::vector<Setting>& settings);

bool serves(const ServeOptions& options, bool classic);  // on any endpoint

}  // namespace racebeam
