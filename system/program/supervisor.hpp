// Runs a command beside a server: two child processes, of which neither outlives this one. Not available on
// Windows.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "system/program/awaited_signals.hpp"

namespace racebeam {

// For a process with one thread. From the construction on, signals are blocked; they are handled while a
// member function waits. All exit statuses are those of shells: 128 and the number of the signal that ended a
// process.
class Supervisor {
 public:
  Supervisor();

  // Makes the server's process, with /dev/null as standard input and, if `log` has a name, with this file as
  // standard error; only this user may read it. Returns true there. Throws std::system_error.
  bool fork_server(const std::filesystem::path& log = {});

  // Waits until the server has made the file `announce`. Returns 0; or an exit status, if the server has
  // ended, or a signal has come.
  int wait_until_ready(const std::filesystem::path& announce);

  // Runs a command until it ends, and passes signals on to it. Returns its exit status: 127 if it is not
  // found, 126 if it cannot be executed. Throws std::system_error.
  int run(const std::vector<std::string>& command);

  // Makes the command's process, for a function of this program. Returns true there. Throws
  // std::system_error.
  bool fork_command();

  // Waits until the command ends, as run() does, and returns its exit status.
  int wait_for_command();

  // Starts a command, and does not wait for it. Throws std::system_error.
  void start(const std::vector<std::string>& command);

  // Waits until the server ends, or a signal comes, after which the server is stopped. Returns the server's
  // exit status. A command that was started may go on.
  int wait();

  // Tells the server to stop, and waits for its end. A signal ends its grace period.
  void stop_server();

 private:
  struct Child {
    int process = 0;  // 0: not running
    int status = 0;
  };

  int fork_child() const;  // returns 0 in the child
  AwaitedSignals::Signal next_signal(int milliseconds = -1);
  void reap();

  AwaitedSignals signals_;
  Child server_, command_;
};

}  // namespace racebeam
