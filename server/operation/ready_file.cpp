#include "server/operation/ready_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string_view>
#include <system_error>

namespace racebeam {
namespace {

constexpr std::string_view kMark = "# racebeam ready file";
constexpr std::string_view kHead =
    ": the addresses of a server, one a line; lines that begin with # are comments\n";

[[noreturn]] void fail(const std::string& path) {
  throw std::runtime_error("cannot write the ready file " + path + ": " +
                           std::generic_category().message(errno));
}

[[noreturn]] void refuse(const std::string& path) {
  throw std::runtime_error("--ready-file " + path +
                           " exists, and is not a ready file: its first line does not begin with '" +
                           std::string(kMark) + "'; choose another name, or remove it");
}

bool begins_with_mark(int file) {
  std::array<char, kMark.size()> text{};
  return ::pread(file, text.data(), text.size(), 0) == static_cast<ssize_t>(text.size()) &&
         std::string_view(text.data(), text.size()) == kMark;
}

// Opens a ready file. Returns its descriptor, or -1 if there is no file. Opens only regular files, and
// follows no link.
int open_ours(const std::string& path) {
  struct stat found {};
  if (::lstat(path.c_str(), &found) != 0) return -1;  // other errors show when it is written
  if (!S_ISREG(found.st_mode)) refuse(path);
  const int file = ::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
  if (file < 0 && errno == ENOENT) return -1;
  if (file < 0) fail(path);
  if (begins_with_mark(file)) return file;
  ::close(file);
  refuse(path);
}

bool is_locked(int file) { return ::flock(file, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK; }

}  // namespace

void remove_stale_ready_file(const std::string& path) {
  const int file = path.empty() ? -1 : open_ours(path);
  if (file < 0) return;
  const bool removed = is_locked(file) || ::unlink(path.c_str()) == 0 || errno == ENOENT;
  ::close(file);
  if (!removed) fail(path);
}

ReadyFile::ReadyFile(const std::string& path, const std::vector<std::string>& addresses) {
  if (const int there = open_ours(path); there >= 0) ::close(there);
  std::string text = std::string(kMark) + std::string(kHead);
  for (const std::string& address : addresses) (text += address) += '\n';
  write(path, text);
}

ReadyFile::~ReadyFile() {
  file_.remove();
  ::close(lock_);
}

void ReadyFile::write(const std::string& path, const std::string& text) {
  std::string temporary = path + ".XXXXXX";
  lock_ = ::mkostemp(temporary.data(), O_CLOEXEC);
  if (lock_ < 0) fail(path);
  ::flock(lock_, LOCK_EX | LOCK_NB);  // a file system without locks: the file counts as stale
  const bool written = ::write(lock_, text.data(), text.size()) == static_cast<ssize_t>(text.size()) &&
                       ::fchmod(lock_, 0644) == 0 && ::fsync(lock_) == 0;
  if (written && ::rename(temporary.c_str(), path.c_str()) == 0) {
    file_ = UnlinkOnExit(path);
    return;
  }
  const int reason = errno;
  ::unlink(temporary.c_str());
  ::close(lock_);
  errno = reason;
  fail(path);
}

}  // namespace racebeam
