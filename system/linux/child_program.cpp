#include "system/child_program.hpp"

#include <fcntl.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <system_error>
#include <utility>

#if defined(__APPLE__)
extern char** environ;  // elsewhere, unistd.h declares it
#endif

namespace racebeam {
namespace {

// The descriptors, process group and signal mask of a child.
class SpawnPlan {
 public:
  SpawnPlan(int input, int errors) {
    ::posix_spawn_file_actions_init(&actions_);
    ::posix_spawn_file_actions_adddup2(&actions_, input, STDIN_FILENO);
    ::posix_spawn_file_actions_addopen(&actions_, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    ::posix_spawn_file_actions_adddup2(&actions_, errors, STDERR_FILENO);
    short flags = POSIX_SPAWN_SETPGROUP | POSIX_SPAWN_SETSIGMASK;
#if defined(__APPLE__)
    flags |= POSIX_SPAWN_CLOEXEC_DEFAULT;
#elif defined(__GLIBC_PREREQ)
#if __GLIBC_PREREQ(2, 34)
    ::posix_spawn_file_actions_addclosefrom_np(&actions_, STDERR_FILENO + 1);  // the sockets of clients, too
#endif
#endif
    sigset_t none;
    sigemptyset(&none);  // a macro on macOS
    ::posix_spawnattr_init(&attributes_);
    ::posix_spawnattr_setsigmask(&attributes_, &none);
    ::posix_spawnattr_setflags(&attributes_, flags);
  }
  ~SpawnPlan() {
    ::posix_spawn_file_actions_destroy(&actions_);
    ::posix_spawnattr_destroy(&attributes_);
  }
  SpawnPlan(const SpawnPlan&) = delete;
  SpawnPlan& operator=(const SpawnPlan&) = delete;

  // Returns 0, or the number of the error.
  int spawn(pid_t& process, std::vector<std::string>& words) const {
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    return ::posix_spawnp(&process, arguments[0], &actions_, &attributes_, arguments.data(), environ);
  }

 private:
  posix_spawn_file_actions_t actions_{};
  posix_spawnattr_t attributes_{};
};

// Returns the two ends of a stream. Other children do not inherit them.
std::array<int, 2> stream() {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()) != 0)
    throw std::system_error(errno, std::generic_category(), "cannot make a socket");
  for (const int end : ends) ::fcntl(end, F_SETFD, FD_CLOEXEC);
#if defined(SO_NOSIGPIPE)  // macOS 11 need not know MSG_NOSIGNAL
  constexpr int kOn = 1;
  ::setsockopt(ends[0], SOL_SOCKET, SO_NOSIGPIPE, &kOn, sizeof kOn);
#endif
  return ends;
}

}  // namespace

struct ChildProgram::Process {
  int input = -1, errors = -1;
  pid_t number = 0;  // 0: not running
  int status = 0;    // how it has ended
};

// The program must not wait until its errors are read, so its end of `errors` does not block.
ChildProgram::ChildProgram(std::vector<std::string> words) : process_(std::make_unique<Process>()) {
  const auto input = stream(), errors = stream();
  process_->input = input[0];
  process_->errors = errors[0];
  const timeval limit{.tv_sec = 0, .tv_usec = 20'000};
  ::setsockopt(input[0], SOL_SOCKET, SO_SNDTIMEO, &limit, sizeof limit);
  ::fcntl(errors[1], F_SETFL, O_NONBLOCK);
  const int failure = SpawnPlan(input[1], errors[1]).spawn(process_->number, words);
  ::close(input[1]);
  ::close(errors[1]);
  if (failure == 0) return;
  close_input();
  ::close(errors[0]);
  throw std::system_error(failure, std::generic_category(), "cannot run " + words[0]);
}

ChildProgram::~ChildProgram() {
  close_input();
  if (process_->number != 0) {
    ::kill(process_->number, SIGKILL);
    ::waitpid(process_->number, nullptr, 0);
  }
  ::close(process_->errors);
}

std::ptrdiff_t ChildProgram::send(std::string_view bytes) {
  const ssize_t sent = ::send(process_->input, bytes.data(), bytes.size(), MSG_NOSIGNAL);
  if (sent > 0) return sent;
  return errno == EAGAIN || errno == EINTR ? 0 : -1;
}

void ChildProgram::close_input() {
  if (has_input()) ::close(std::exchange(process_->input, -1));
}

bool ChildProgram::has_input() const { return process_->input >= 0; }

bool ChildProgram::has_ended() {
  if (process_->number != 0 && ::waitpid(process_->number, &process_->status, WNOHANG) == process_->number)
    process_->number = 0;
  return process_->number == 0;
}

bool ChildProgram::has_succeeded() const {
  return process_->number == 0 && WIFEXITED(process_->status) && WEXITSTATUS(process_->status) == 0;
}

std::string ChildProgram::errors() {
  std::string text;
  std::array<char, 4096> bytes{};
  ssize_t count = 0;
  while ((count = ::recv(process_->errors, bytes.data(), bytes.size(), MSG_DONTWAIT)) > 0)
    text.append(bytes.data(), static_cast<std::size_t>(count));
  return text;
}

}  // namespace racebeam
