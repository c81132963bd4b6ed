#include "agents/base/file_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace racebeam {

FileLock::FileLock(const std::string& path) : FileLock() {
  do {
    open(path);
    lock(path, LOCK_EX);
  } while (!is_at(path));
}

std::optional<FileLock> FileLock::attempt(const std::string& path) {
  std::optional<FileLock> lock_file(FileLock{});
  do {
    lock_file->open(path);
    if (!lock_file->lock(path, LOCK_EX | LOCK_NB)) return std::nullopt;
  } while (!lock_file->is_at(path));
  return lock_file;
}

FileLock::~FileLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void FileLock::open(const std::string& path) {
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
  if (descriptor_ < 0) throw std::system_error(errno, std::generic_category(), "cannot make " + path);
}

bool FileLock::lock(const std::string& path, int how) {
  while (::flock(descriptor_, how) != 0) {
    if (errno == EWOULDBLOCK) return false;
    if (errno != EINTR) throw std::system_error(errno, std::generic_category(), "cannot lock " + path);
  }
  return true;
}

bool FileLock::is_at(const std::string& path) const {
  struct stat own {
  }, named{};
  return ::fstat(descriptor_, &own) == 0 && ::stat(path.c_str(), &named) == 0 && own.st_dev == named.st_dev &&
         own.st_ino == named.st_ino;
}

}  // namespace racebeam
