#include "server/ready_file.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <system_error>
#include <utility>

namespace racebeam {
namespace {

[[noreturn]] void fail(const std::string& path) {
  throw std::runtime_error("cannot write the ready file " + path + ": " +
                           std::generic_category().message(errno));
}

void remove(const std::string& path) {
  if (::unlink(path.c_str()) != 0 && errno != ENOENT) fail(path);
}

}  // namespace

ReadyFile::ReadyFile(std::string path) : path_(std::move(path)) { remove(path_); }

ReadyFile::~ReadyFile() { file_.remove(); }

void ReadyFile::write(const std::vector<std::string>& addresses) {
  std::string text;
  for (const std::string& address : addresses) (text += address) += '\n';
  std::string temporary = path_ + ".XXXXXX";
  const int file = ::mkostemp(temporary.data(), 0);
  if (file < 0) fail(path_);
  const bool written = ::write(file, text.data(), text.size()) == static_cast<ssize_t>(text.size()) &&
                       ::fchmod(file, 0644) == 0 && ::fsync(file) == 0;
  ::close(file);
  if (written && ::rename(temporary.c_str(), path_.c_str()) == 0) {
    file_ = OwnFile(path_);
    return;
  }
  const int reason = errno;
  ::unlink(temporary.c_str());
  errno = reason;
  fail(path_);
}

}  // namespace racebeam
