#include "system/file_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <cerrno>

namespace racebeam {

bool lock_file(int file, Waiting waiting) {
  while (::flock(file, waiting == Waiting::kYes ? LOCK_EX : LOCK_EX | LOCK_NB) != 0) {
    if (errno != EINTR) return false;
  }
  return true;
}

bool is_locked_elsewhere(int error) { return error == EWOULDBLOCK; }

bool is_locked(int file) { return ::flock(file, LOCK_SH | LOCK_NB) != 0 && is_locked_elsewhere(errno); }

int open_lock(const std::string& path) { return ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644); }

int open_lock_of_folder(const std::string& path) {
  return ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
}

bool is_at(int file, const std::string& path) {
  struct stat own {
  }, named{};
  return ::fstat(file, &own) == 0 && ::stat(path.c_str(), &named) == 0 && own.st_dev == named.st_dev &&
         own.st_ino == named.st_ino;
}

}  // namespace racebeam
