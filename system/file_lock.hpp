// Locks between processes. A lock is released when its process ends, in any way.
#pragma once

#include <optional>
#include <string>
#include <utility>

namespace racebeam {

// Locks an open file until it is closed. With Waiting::kNo, returns false if another process holds the lock,
// and leaves the reason in errno.
enum class Waiting { kNo, kYes };
bool lock_file(int file, Waiting waiting);
bool is_locked_elsewhere(int error);  // whether lock_file() failed with this errno because of another lock
bool is_locked(int file);             // whether another descriptor of the file has locked it

int open_lock(const std::string& path);            // makes the file; returns -1 if that fails
int open_lock_of_folder(const std::string& path);  // -1: it cannot be locked
bool is_at(int file, const std::string& path);     // whether the file at this path is the open file

// A file that one process holds. That process may remove the file; processes that wait for it then lock the
// file that is created next.
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

  bool take(const std::string& path, Waiting waiting);

  int descriptor_ = -1;
};

}  // namespace racebeam
