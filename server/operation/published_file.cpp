#include "server/operation/published_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <system_error>

#include "server/operation/log.hpp"

namespace racebeam {
namespace {

[[noreturn]] void fail(const FileKind& kind, const std::string& path) {
  throw std::runtime_error("cannot write the " + std::string(kind.name) + " " + path + ": " +
                           std::generic_category().message(errno));
}

std::string without_end(std::string_view line) { return std::string(line.substr(0, line.find('\n'))); }

[[noreturn]] void refuse(const FileKind& kind, const std::string& path) {
  throw std::runtime_error(std::string(kind.option) + " " + path + " exists, and is not " +
                           (kind.name.starts_with('a') ? "an " : "a ") + std::string(kind.name) +
                           ": it does not begin with '" + without_end(kind.mark) +
                           "'; choose another name, or remove it");
}

bool begins_with(const std::string_view mark, int file) {
  std::string text(mark.size(), '\0');
  return ::pread(file, text.data(), text.size(), 0) == static_cast<ssize_t>(text.size()) && text == mark;
}

// Opens a file of this kind. Returns its descriptor, or -1 if it is missing. Opens only regular files, and
// follows no link.
int open_ours(const FileKind& kind, const std::string& path) {
  struct stat found {};
  if (::lstat(path.c_str(), &found) != 0) return -1;  // other errors show when it is written
  if (!S_ISREG(found.st_mode)) refuse(kind, path);
  const int file = ::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (file < 0 && errno == ENOENT) return -1;
  if (file < 0) fail(kind, path);
  if (begins_with(kind.mark, file)) return file;
  ::close(file);
  refuse(kind, path);
}

bool is_locked(int file) { return ::flock(file, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK; }

bool write_all(int file, std::string_view text) {
  while (!text.empty()) {
    const ssize_t count = ::write(file, text.data(), text.size());
    if (count < 0) return false;
    text.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
}

}  // namespace

void remove_stale(const FileKind& kind, const std::string& path) {
  const int file = path.empty() ? -1 : open_ours(kind, path);
  if (file < 0) return;
  const bool removed = is_locked(file) || ::unlink(path.c_str()) == 0 || errno == ENOENT;
  ::close(file);
  if (!removed) fail(kind, path);
}

PublishedFile::PublishedFile(const FileKind& kind, const std::string& path, const std::string& text) {
  if (const int there = open_ours(kind, path); there >= 0) {
    if (is_locked(there))
      log_warning("the " + std::string(kind.name) + " " + path +
                  " of another server, which runs, is replaced");
    ::close(there);
  }
  write(kind, path, text);
}

PublishedFile::~PublishedFile() {
  file_.remove();
  ::close(lock_);
}

void PublishedFile::write(const FileKind& kind, const std::string& path, const std::string& text) {
  std::string temporary = path + ".XXXXXX";
  lock_ = ::mkostemp(temporary.data(), O_CLOEXEC);
  if (lock_ < 0) fail(kind, path);
  ::flock(lock_, LOCK_EX | LOCK_NB);  // a file system without locks: the file counts as stale
  const bool written = write_all(lock_, text) && ::fchmod(lock_, kind.mode) == 0 && ::fsync(lock_) == 0;
  if (written && ::rename(temporary.c_str(), path.c_str()) == 0) {
    file_ = UnlinkOnExit(path);
    return;
  }
  const int reason = errno;
  ::unlink(temporary.c_str());
  ::close(lock_);
  errno = reason;
  fail(kind, path);
}

}  // namespace racebeam
