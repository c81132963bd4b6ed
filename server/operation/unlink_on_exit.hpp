// A file that this server has made. It is removed at the end, unless it has been replaced under the same
// name.
#pragma once

#include <sys/stat.h>
#include <unistd.h>

#include <string>
#include <utility>

namespace racebeam {

class UnlinkOnExit {
 public:
  UnlinkOnExit() = default;  // no file
  explicit UnlinkOnExit(std::string path) : path_(std::move(path)), mark_(mark_of(path_)) {}
  ~UnlinkOnExit() { remove(); }
  UnlinkOnExit(UnlinkOnExit&& other) noexcept
      : path_(std::move(other.path_)), mark_(std::exchange(other.mark_, {})) {}
  UnlinkOnExit& operator=(UnlinkOnExit&& other) noexcept {
    remove();
    path_ = std::move(other.path_);
    mark_ = std::exchange(other.mark_, {});
    return *this;
  }

  // Removes the file, unless it is gone or replaced. Only once.
  void remove() {
    const Mark mark = std::exchange(mark_, {});
    if (mark.number != 0 && mark_of(path_) == mark) ::unlink(path_.c_str());
  }

 private:
  // The system may give the inode number of a removed file to the next one; the time then differs. That of a
  // pipe does not count: it changes with each write.
  struct Mark {
    ino_t number = 0;
    time_t seconds = 0;
    long nanoseconds = 0;
    bool operator==(const Mark&) const = default;
  };

  static Mark mark_of(const std::string& path) {
    struct stat found {};
    if (::lstat(path.c_str(), &found) != 0) return {};
    if (S_ISFIFO(found.st_mode)) return {found.st_ino};
    return {found.st_ino, found.st_mtim.tv_sec, found.st_mtim.tv_nsec};
  }

  std::string path_;
  Mark mark_;
};

}  // namespace racebeam
