#include "system/program/blocking_pair.hpp"

#include <windows.h>

#include <pthread.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <condition_variable>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "system/windows/files.hpp"

namespace racebeam {
namespace {

// Reads standard input on a separate thread. The thread is detached, since some reads cannot be interrupted.
class Reader {
 public:
  void start(int in) {
    if (!std::exchange(has_started_, true)) std::thread([this, in] { run(handle_of(in)); }).detach();
  }

  bool has_read() const { return has_read_; }

  void wait(const std::atomic<bool>& halt) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return has_read_ || halt; });
  }

  // Takes bytes that have been read. Returns their number; 0 at the end of the input.
  std::size_t take(std::span<char> space) {
    const std::lock_guard lock(mutex_);
    const std::size_t count = std::min(space.size(), rest_.size());
    std::ranges::copy(rest_.first(count), space.begin());
    rest_ = rest_.subspan(count);
    if (rest_.empty() && !ended_) has_read_ = false;
    changed_.notify_all();
    return count;
  }

  void wake() { changed_.notify_all(); }

 private:
  void run(HANDLE in) {
    while (!ended_) {
      DWORD count = 0;
      const bool read = ReadFile(in, bytes_.data(), DWORD{kPiece}, &count, nullptr) != 0;
      if (!read && GetLastError() == ERROR_OPERATION_ABORTED) continue;  // Ctrl-C in a console
      std::unique_lock lock(mutex_);
      rest_ = std::span(bytes_).first(count);
      ended_ = rest_.empty();
      has_read_ = true;
      changed_.notify_all();
      changed_.wait(lock, [this] { return ended_ || !has_read_; });
    }
  }

  static constexpr std::size_t kPiece = 1 << 16;

  std::mutex mutex_;
  std::condition_variable changed_;
  std::atomic<bool> has_read_ = false;
  bool has_started_ = false, ended_ = false;
  std::array<char, kPiece> bytes_{};
  std::span<char> rest_;
};

// The only Reader. Its thread goes on until the process ends.
Reader& reader() {
  static Reader& one = *new Reader;
  return one;
}

}  // namespace

PathKind kind_of_path(const std::string&) { return PathKind::kMissing; }

bool make_pipe(const std::string&) {
  errno = ENOSYS;
  return false;
}

bool is_pipe(int descriptor) { return GetFileType(handle_of(descriptor)) == FILE_TYPE_PIPE; }

void Halt::prepare() {}

// Also cancels a write, if the system can do that.
void Halt::wake(std::jthread& thread) {
  reader().wake();
  CancelSynchronousIo(pthread_gethandle(thread.native_handle()));
}

BlockingPair::~BlockingPair() = default;

void BlockingPair::use(int in, int out) {
  in_ = in;
  out_ = out;
  reader().start(in);
}

bool BlockingPair::open(int&, const std::string& path, int) {
  throw std::runtime_error("cannot open the pipe " + path + ": Windows has no such pipes");
}
bool BlockingPair::open_out(const std::string& path, bool) { return open(out_, path, 0); }
bool BlockingPair::open_in(const std::string& path) { return open(in_, path, 0); }

std::size_t BlockingPair::read(std::span<char> space) {
  const auto began = BusyPoll::Clock::now();
  const auto found = quick_ ? read_awake(space) : std::nullopt;
  const std::size_t count = found ? *found : read_asleep(space);
  quick_ = busy_.received_after(BusyPoll::Clock::now() - began);
  return count;
}

std::optional<std::size_t> BlockingPair::read_at_once(std::span<char> space) {
  if (halt_.reading || !reader().has_read()) return std::nullopt;
  return reader().take(space);
}

std::optional<std::size_t> BlockingPair::read_awake(std::span<char> space) {
  for (busy_.begin(); !halt_.reading && busy_.again();) {
    if (const auto count = read_at_once(space)) return count;
  }
  return std::nullopt;
}

std::size_t BlockingPair::read_asleep(std::span<char> space) {
  reader().wait(halt_.reading);
  return halt_.reading ? 0 : reader().take(space);
}

bool BlockingPair::write(std::string_view text) {
  while (!text.empty()) {
    if (halt_.all) return false;
    DWORD count = 0;
    if (WriteFile(handle_of(out_), text.data(), static_cast<DWORD>(text.size()), &count, nullptr) != 0)
      text.remove_prefix(count);
    else if (GetLastError() != ERROR_OPERATION_ABORTED)
      return false;
  }
  return true;
}

// The system does not tell whether a pipe has room, so this write may wait. The next Halt::wake() cancels it.
void BlockingPair::write_at_once(std::string_view text) {
  DWORD count = 0;
  WriteFile(handle_of(out_), text.data(), static_cast<DWORD>(text.size()), &count, nullptr);
}

// The system does not tell whether the reader has left, either.
bool BlockingPair::reader_left() const { return false; }

}  // namespace racebeam
