#include "system/program/supervisor.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <iostream>
#include <string>
#include <system_error>

#include "system/printable.hpp"
#include "system/program/execute.hpp"
#include "system/program/parent_process.hpp"

namespace racebeam {
namespace {

constexpr int kHandled[] = {SIGCHLD, SIGTERM, SIGINT, SIGHUP, SIGQUIT, SIGUSR1, SIGUSR2};
constexpr int kFailed = 1, kNotFound = 127, kNotExecutable = 126, kSignalled = 128;

int status_of(int ended) { return WIFEXITED(ended) ? WEXITSTATUS(ended) : kSignalled + WTERMSIG(ended); }

[[noreturn]] void become(const std::vector<std::string>& command) {
  const int reason = execute(command);
  std::cerr << "racebeam: cannot execute " << printable(command[0]) << ": " << std::strerror(reason) << "\n";
  ::_exit(reason == ENOENT ? kNotFound : kNotExecutable);
}

// Puts a file in the place of a standard stream.
void replace(int stream, const char* path, int flags) {
  const int file = ::open(path, flags | O_CLOEXEC, 0600);
  if (file < 0 || ::dup2(file, stream) < 0)
    throw std::system_error(errno, std::generic_category(), "cannot open " + std::string(path));
  if (file != stream) ::close(file);
}

}  // namespace

Supervisor::Supervisor() : signals_(kHandled) {}

int Supervisor::fork_child() const {
  const int parent = ::getpid();
  const int child = ::fork();
  if (child < 0) throw std::system_error(errno, std::generic_category(), "cannot start a process");
  if (child > 0) return child;
  if (!end_with_parent(parent)) ::_exit(kFailed);
  signals_.handle_as_before();
  return 0;
}

// In its own process group, the server does not get the signals of the terminal.
bool Supervisor::fork_server(const std::filesystem::path& log) {
  server_.process = fork_child();
  if (server_.process != 0) return false;
  ::setpgid(0, 0);
  replace(STDIN_FILENO, "/dev/null", O_RDONLY);
  if (!log.empty()) replace(STDERR_FILENO, log.c_str(), O_WRONLY | O_CREAT | O_APPEND);
  return true;
}

int Supervisor::wait_until_ready(const std::filesystem::path& announce) {
  constexpr int kBetweenLooks = 5;
  std::error_code ignored;
  while (!std::filesystem::exists(announce, ignored)) {
    const int signal = next_signal(kBetweenLooks).number;
    if (server_.process == 0) return server_.status == 0 ? kFailed : server_.status;
    if (signal == 0 || signal == SIGCHLD) continue;
    stop_server();
    return kSignalled + signal;
  }
  return 0;
}

bool Supervisor::fork_command() {
  command_.process = fork_child();
  return command_.process == 0;
}

void Supervisor::start(const std::vector<std::string>& command) {
  if (fork_command()) become(command);
}

int Supervisor::run(const std::vector<std::string>& command) {
  start(command);
  return wait_for_command();
}

// The terminal sends Ctrl-C to the command itself.
int Supervisor::wait_for_command() {
  bool serves = server_.process != 0;
  while (command_.process != 0) {
    const auto signal = next_signal();
    if (signal.number != SIGCHLD && command_.process != 0 && !signal.from_terminal)
      ::kill(command_.process, signal.number);
    if (serves && server_.process == 0 && server_.status != 0)
      std::cerr << "racebeam: the server has ended with status " << server_.status << "\n";
    serves = server_.process != 0;
  }
  return command_.status;
}

int Supervisor::wait() {
  while (server_.process != 0) {
    const int signal = next_signal().number;
    if (signal != 0 && signal != SIGCHLD) stop_server();
  }
  return server_.status;
}

void Supervisor::stop_server() {
  if (server_.process != 0) ::kill(server_.process, SIGTERM);
  while (server_.process != 0) {
    const int signal = next_signal().number;
    if (signal != SIGCHLD && server_.process != 0) ::kill(server_.process, SIGTERM);
  }
}

AwaitedSignals::Signal Supervisor::next_signal(int milliseconds) {
  const auto signal = signals_.next(milliseconds);
  reap();
  return signal;
}

void Supervisor::reap() {
  int ended = 0;
  for (Child* child : {&server_, &command_}) {
    if (child->process == 0 || ::waitpid(child->process, &ended, WNOHANG) != child->process) continue;
    *child = {0, status_of(ended)};
  }
}

}  // namespace racebeam
