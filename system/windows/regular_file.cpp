#include "system/regular_file.hpp"

#include <fcntl.h>
#include <io.h>
#include <sys/stat.h>

#include <cerrno>

namespace racebeam {
namespace {

// The reason to refuse a file with these properties; empty if none.
std::string refusal_of(int status, const struct _stat64& found) {
  if (status != 0) return read_refusal(errno);
  switch (found.st_mode & _S_IFMT) {
    case _S_IFDIR: return "this is a directory, not a file";
    case _S_IFIFO: return "this is a pipe, not a file";
    case _S_IFCHR: return "this is a device, not a file";
    default: return {};
  }
}

}  // namespace

// A directory cannot be opened, so its kind is asked for before.
OpenedFile open_regular_file(const std::string& path) {
  struct _stat64 found {};
  OpenedFile file;
  file.refusal = refusal_of(_stat64(path.c_str(), &found), found);
  if (!file.refusal.empty()) return file;
  file.descriptor = _open(path.c_str(), _O_RDONLY | _O_BINARY | _O_NOINHERIT);
  if (file.descriptor < 0) return {-1, read_refusal(errno)};
  file.refusal = refusal_of(_fstat64(file.descriptor, &found), found);
  if (file.refusal.empty()) return file;
  _close(file.descriptor);
  return {-1, file.refusal};
}

std::ptrdiff_t read_from(int descriptor, std::span<char> bytes) {
  return _read(descriptor, bytes.data(), static_cast<unsigned>(bytes.size()));
}

void close_file(int descriptor) { _close(descriptor); }

}  // namespace racebeam
