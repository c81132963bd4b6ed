#include "cli/commands/supervisor.hpp"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <iostream>
#include <system_error>

#include "cli/arguments/options.hpp"
#include "system/printable.hpp"
#include "system/program/parent_process.hpp"

namespace racebeam {
namespace {

constexpr int kHandled[] = {SIGCHLD, SIGTERM, SIGINT, SIGHUP, SIGQUIT, SIGUSR1, SIGUSR2};
constexpr int kNotFound = 127, kNotExecutable = 126, kSignalled = 128;

[[noreturn]] void fail(const char* what) { throw std::system_error(errno, std::generic_category(), what); }

int status_of(int ended) { return WIFEXITED(ended) ? WEXITSTATUS(ended) : kSignalled + WTERMSIG(ended); }

[[noreturn]] void execute(const std::vector<std::string>& command) {
  std::vector<char*> words;
  for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
  words.push_back(nullptr);
  ::execvp(words[0], words.data());
  const int reason = errno;
  std::cerr << "racebeam: cannot execute " << printable(command[0]) << ": " << std::strerror(reason) << "\n";
  ::_exit(reason == ENOENT ? kNotFound : kNotExecutable);
}

}  // namespace

PrivateFolder::PrivateFolder() : owner_(::getpid()) {
  const char* const parent = std::getenv("TMPDIR");
  std::string name =
      (parent == nullptr || *parent == '\0' ? "/tmp" : std::string(parent)) + "/racebeam-XXXXXX";
  if (::mkdtemp(name.data()) == nullptr) fail(("cannot make a folder " + name).c_str());
  path_ = name;
}

PrivateFolder::~PrivateFolder() {
  if (::getpid() != owner_ && ::getppid() == owner_) return;
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

Supervisor::Supervisor() : signals_(kHandled) {}

pid_t Supervisor::fork_child() const {
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child < 0) fail("cannot start a process");
  if (child > 0) return child;
  if (!end_with_parent(parent)) ::_exit(kExitFailure);
  signals_.handle_as_before();
  return 0;
}

// In its own process group, the server does not get the signals of the terminal.
bool Supervisor::fork_server() {
  server_.process = fork_child();
  if (server_.process != 0) return false;
  ::setpgid(0, 0);
  if (const int nothing = ::open("/dev/null", O_RDONLY); nothing > STDIN_FILENO) {
    ::dup2(nothing, STDIN_FILENO);
    ::close(nothing);
  }
  return true;
}

int Supervisor::wait_until_ready(const std::filesystem::path& announce) {
  constexpr int kBetweenLooks = 5;
  std::error_code ignored;
  while (!std::filesystem::exists(announce, ignored)) {
    const int signal = next_signal(kBetweenLooks).number;
    if (server_.process == 0) return server_.status == 0 ? kExitFailure : server_.status;
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
  if (fork_command()) execute(command);
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
