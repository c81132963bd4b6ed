#include "system/regular_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>

namespace racebeam {
namespace {

struct Kind {
  mode_t mode;
  const char* name;
};
constexpr std::array kKinds = {Kind{S_IFDIR, "a directory"}, Kind{S_IFIFO, "a pipe"},
                               Kind{S_IFSOCK, "a socket"}, Kind{S_IFCHR, "a device"},
                               Kind{S_IFBLK, "a device"}};

// The reason to refuse a file with these properties; empty if it is accepted.
std::string refusal_of(int status, const struct stat& found) {
  if (status != 0) return read_refusal(errno);
  for (const Kind& kind : kKinds)
    if ((found.st_mode & S_IFMT) == kind.mode) return "this is " + std::string(kind.name) + ", not a file";
  return {};
}

}  // namespace

// Opening a device may have an effect, so the file's kind is checked before. The name may be changed
// meanwhile, so the file is opened without blocking, and checked again.
OpenedFile open_regular_file(const std::string& path) {
  struct stat found {};
  OpenedFile file;
  file.refusal = refusal_of(::stat(path.c_str(), &found), found);
  if (!file.refusal.empty()) return file;
  file.descriptor = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  if (file.descriptor < 0) return {-1, read_refusal(errno)};
  file.refusal = refusal_of(::fstat(file.descriptor, &found), found);
  if (file.refusal.empty()) return file;
  ::close(file.descriptor);
  return {-1, file.refusal};
}

std::ptrdiff_t read_from(int descriptor, std::span<char> bytes) {
  for (;;) {
    const ssize_t count = ::read(descriptor, bytes.data(), bytes.size());
    if (count >= 0 || errno != EINTR) return count;
  }
}

int duplicate_descriptor(int descriptor) { return ::dup(descriptor); }
void close_file(int descriptor) { ::close(descriptor); }

}  // namespace racebeam
