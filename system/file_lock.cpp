#include "system/file_lock.hpp"

#include <cerrno>
#include <system_error>

#include "system/regular_file.hpp"

namespace racebeam {
namespace {

[[noreturn]] void fail(const std::string& what, const std::string& path) {
  throw std::system_error(errno, std::generic_category(), "cannot " + what + " " + path);
}

}  // namespace

FileLock::FileLock(const std::string& path) : FileLock() { take(path, Waiting::kYes); }

std::optional<FileLock> FileLock::attempt(const std::string& path) {
  std::optional<FileLock> lock(FileLock{});
  if (!lock->take(path, Waiting::kNo)) return std::nullopt;
  return lock;
}

FileLock::~FileLock() {
  if (descriptor_ >= 0) close_file(descriptor_);
}

bool FileLock::take(const std::string& path, Waiting waiting) {
  do {
    if (descriptor_ >= 0) close_file(descriptor_);
    descriptor_ = open_lock(path);
    if (descriptor_ < 0) fail("make", path);
    if (lock_file(descriptor_, waiting)) continue;
    if (!is_locked_elsewhere(errno)) fail("lock", path);
    return false;
  } while (!is_at(descriptor_, path));
  return true;
}

}  // namespace racebeam
