#include "system/program/blocking_pair.hpp"

#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <stdexcept>
#include <system_error>

#include "system/program/without_waiting.hpp"

namespace racebeam {
namespace {

constexpr int kWakingSignal = SIGUSR1;

void wait_until(int descriptor, short ready) {
  pollfd state{descriptor, ready, 0};
  ::poll(&state, 1, -1);
}

}  // namespace

PathKind kind_of_path(const std::string& path) {
  struct stat found {};
  if (::stat(path.c_str(), &found) != 0) return PathKind::kMissing;
  return S_ISFIFO(found.st_mode) ? PathKind::kPipe : PathKind::kOther;
}

bool make_pipe(const std::string& path) { return ::mkfifo(path.c_str(), 0600) == 0; }

bool is_pipe(int descriptor) {
  struct stat found {};
  return ::fstat(descriptor, &found) == 0 && (S_ISFIFO(found.st_mode) || S_ISSOCK(found.st_mode));
}

// Installs a handler that does nothing. Without SA_RESTART, a call that it interrupts ends with EINTR.
void Halt::prepare() {
  struct sigaction action {};
  action.sa_handler = [](int) {};
  ::sigaction(kWakingSignal, &action, nullptr);
}

void Halt::wake(std::jthread& thread) { ::pthread_kill(thread.native_handle(), kWakingSignal); }

BlockingPair::~BlockingPair() {
  for (const int descriptor : {in_, out_}) {
    if (descriptor > STDERR_FILENO) ::close(descriptor);
  }
}

void BlockingPair::use(int in, int out) {
  in_ = in;
  out_ = out;
  make_room(out_);
}

bool BlockingPair::open(int& descriptor, const std::string& path, int flags) {
  while (!halt_.reading) {
    descriptor = ::open(path.c_str(), flags | O_CLOEXEC, 0666);
    if (descriptor >= 0) return true;
    if (errno == EINTR) continue;
    throw std::runtime_error("cannot open the pipe " + path + ": " + std::generic_category().message(errno));
  }
  return false;
}

bool BlockingPair::open_out(const std::string& path, bool makes_file) {
  if (!open(out_, path, makes_file ? O_WRONLY | O_CREAT | O_TRUNC : O_WRONLY)) return false;
  make_room(out_);
  return true;
}

bool BlockingPair::open_in(const std::string& path) { return open(in_, path, O_RDONLY); }

std::size_t BlockingPair::read(std::span<char> space) {
  const auto began = BusyPoll::Clock::now();
  const auto found = quick_ ? read_awake(space) : std::nullopt;
  const std::size_t count = found ? *found : read_asleep(space);
  quick_ = busy_.received_after(BusyPoll::Clock::now() - began);
  return count;
}

std::optional<std::size_t> BlockingPair::read_at_once(std::span<char> space) {
  if (halt_.reading) return std::nullopt;
  const std::ptrdiff_t count = read_without_waiting(in_, space);
  return count < 0 ? std::nullopt : std::optional(static_cast<std::size_t>(count));
}

// Where the system cannot read without waiting, the work is left to read_asleep().
std::optional<std::size_t> BlockingPair::read_awake(std::span<char> space) {
  for (busy_.begin(); busy_.again();) {
    if (const auto count = read_at_once(space)) return count;
    if (halt_.reading || errno != EAGAIN) break;
  }
  return std::nullopt;
}

std::size_t BlockingPair::read_asleep(std::span<char> space) {
  while (!halt_.reading) {
    const ssize_t count = ::read(in_, space.data(), space.size());
    if (count >= 0) return static_cast<std::size_t>(count);
    if (errno == EAGAIN) {
      wait_until(in_, POLLIN);
    } else if (errno != EINTR) {
      break;
    }
  }
  return 0;
}

bool BlockingPair::write(std::string_view text) {
  while (!text.empty()) {
    if (halt_.all) return false;
    const ssize_t count = ::write(out_, text.data(), text.size());
    if (count >= 0) {
      text.remove_prefix(static_cast<std::size_t>(count));
    } else if (errno == EAGAIN) {
      wait_until(out_, POLLOUT);
    } else if (errno != EINTR) {
      return false;
    }
  }
  return true;
}

// A pipe that is ready takes PIPE_BUF bytes without waiting.
void BlockingPair::write_at_once(std::string_view text) {
  pollfd state{out_, POLLOUT, 0};
  const bool ready = ::poll(&state, 1, 0) > 0 && (state.revents & POLLOUT) != 0;
  if (ready && ::write(out_, text.data(), text.size()) < 0) return;  // the client has gone
}

bool BlockingPair::reader_left() const {
  pollfd state{out_, 0, 0};
  return ::poll(&state, 1, 0) > 0 && (state.revents & (POLLERR | POLLHUP)) != 0;
}

}  // namespace racebeam
