#include "recording/film_encoder.hpp"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <thread>
#include <utility>

#include "system/printable.hpp"

#if defined(__APPLE__)
extern char** environ;  // elsewhere, unistd.h declares it
#endif

namespace racebeam {
namespace {

using namespace std::chrono_literals;

constexpr std::size_t kLongestReason = 300;  // characters

[[noreturn]] void refuse(const std::string& what, int reason) {
  throw EncoderFailed(what + ": " + std::strerror(reason));
}

// What a child gets instead of what this process has.
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
    ::sigemptyset(&none);
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

  // Returns 0 or the reason.
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

// Two ends of a stream, which no other child inherits.
std::array<int, 2> stream() {
  std::array<int, 2> ends{};
  if (::socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()) != 0) refuse("cannot make a socket", errno);
  for (const int end : ends) ::fcntl(end, F_SETFD, FD_CLOEXEC);
  return ends;
}

}  // namespace

// Errors that nobody reads yet must not make the program wait, so its end of `errors` does not block.
FilmEncoder::FilmEncoder(std::vector<std::string> words, std::function<bool()> given_up,
                         std::chrono::milliseconds patience)
    : name_(words.at(0)), given_up_(std::move(given_up)), patience_(patience) {
  const auto input = stream(), errors = stream();
  input_ = input[0];
  errors_ = errors[0];
  const timeval limit{.tv_sec = 0, .tv_usec = 20'000};  // of one call, after which others are asked
  ::setsockopt(input_, SOL_SOCKET, SO_SNDTIMEO, &limit, sizeof limit);
  ::fcntl(errors[1], F_SETFL, O_NONBLOCK);
  const int failure = SpawnPlan(input[1], errors[1]).spawn(process_, words);
  ::close(input[1]);
  ::close(errors[1]);
  if (failure == 0) return;
  close_input();
  ::close(errors_);
  process_ = 0;
  if (failure == ENOENT) throw EncoderFailed(name_ + " is not installed: the PATH has no such program");
  refuse("cannot run " + name_, failure);
}

FilmEncoder::~FilmEncoder() {
  close_input();
  if (process_ != 0) {
    ::kill(process_, SIGKILL);
    ::waitpid(process_, nullptr, 0);
  }
  ::close(errors_);
}

void FilmEncoder::write(std::string_view bytes) {
  const Time begin = std::chrono::steady_clock::now();
  while (!bytes.empty()) {
    const ssize_t sent = ::send(input_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    if (sent > 0) {
      bytes.remove_prefix(static_cast<std::size_t>(sent));
    } else if (errno == EAGAIN || errno == EINTR) {
      check_patience(begin);
    } else {
      wait_for_end();
      fail("it does not read any more");
    }
  }
}

void FilmEncoder::finish() {
  close_input();
  wait_for_end();
  if (!WIFEXITED(status_) || WEXITSTATUS(status_) != 0) fail("it did not succeed");
}

void FilmEncoder::wait_for_end() {
  constexpr auto kBetweenLooks = 2ms;
  const Time begin = std::chrono::steady_clock::now();
  while (process_ != 0) {
    if (::waitpid(process_, &status_, WNOHANG) == process_) {
      process_ = 0;
    } else {
      check_patience(begin);
      std::this_thread::sleep_for(kBetweenLooks);
    }
  }
}

void FilmEncoder::check_patience(Time begin) const {
  if (given_up_ && given_up_()) throw EncoderFailed(name_ + " is not waited for any more");
  if (std::chrono::steady_clock::now() > begin + patience_)
    throw EncoderFailed(name_ + (input_ < 0 ? " does not end" : " does nothing any more"));
}

void FilmEncoder::fail(const std::string& otherwise) {
  const std::string words = last_words();
  throw EncoderFailed(name_ + " failed: " + (words.empty() ? otherwise : words));
}

// Its last line, or the beginning of a long one.
std::string FilmEncoder::last_words() {
  std::array<char, 4096> bytes{};
  ssize_t count = 0;
  while ((count = ::recv(errors_, bytes.data(), bytes.size(), MSG_DONTWAIT)) > 0)
    said_.append(bytes.data(), static_cast<std::size_t>(count));
  while (said_.ends_with('\n') || said_.ends_with('\r')) said_.pop_back();
  return printable(said_.substr(said_.rfind('\n') + 1, kLongestReason));
}

void FilmEncoder::close_input() {
  if (input_ >= 0) ::close(std::exchange(input_, -1));
}

}  // namespace racebeam
