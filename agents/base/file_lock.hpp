// A lock between processes: a file that one of them holds. It is free when its process is gone, however that
// ended.
#pragma once

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <optional>
#include <string>
#include <system_error>

namespace racebeam {

class FileLock {
 public:
  // Waits for the lock. Throws std::system_error if the file cannot be made.
  explicit FileLock(const std::string& path) : FileLock(path, LOCK_EX) {}

  // Returns nothing if another process, or another thread, holds it.
  static std::optional<FileLock> attempt(const std::string& path) {
    std::optional<FileLock> lock(FileLock(path, LOCK_EX | LOCK_NB));
    if (lock->descriptor_ < 0) return std::nullopt;
    return lock;
  }

  FileLock(FileLock&& other) noexcept : descriptor_(other.descriptor_) { other.descriptor_ = -1; }
  FileLock& operator=(FileLock&&) = delete;
  ~FileLock() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }

 private:
  FileLock(const std::string& path, int how)
      : descriptor_(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644)) {
    if (descriptor_ < 0) throw std::system_error(errno, std::generic_category(), "cannot make " + path);
    if (::flock(descriptor_, how) == 0) return;
    const int reason = errno;
    ::close(descriptor_);
    descriptor_ = -1;
    if (reason != EWOULDBLOCK)
      throw std::system_error(reason, std::generic_category(), "cannot lock " + path);
  }

  int descriptor_;
};

}  // namespace racebeam
