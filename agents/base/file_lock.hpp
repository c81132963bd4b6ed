// A lock between processes: a file that one of them holds. It is free when its process is gone, however that
// ended. Its holder may remove the file: processes that wait for it then lock the file that is there next.
#pragma once

#include <optional>
#include <string>
#include <utility>

namespace racebeam {

class FileLock {
 public:
  // Waits for the lock. Throws std::system_error if the file cannot be made.
  explicit FileLock(const std::string& path);

  // Returns nothing if another process, or another thread, holds it.
  static std::optional<FileLock> attempt(const std::string& path);

  FileLock(FileLock&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  FileLock& operator=(FileLock&&) = delete;
  ~FileLock();

 private:
  FileLock() = default;

  void open(const std::string& path);
  bool lock(const std::string& path, int how);  // returns false if LOCK_NB is in `how`, and another holds it
  bool is_at(const std::string& path) const;    // whether the name still means the file that is locked

  int descriptor_ = -1;
};

}  // namespace racebeam
