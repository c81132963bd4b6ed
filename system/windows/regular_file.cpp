#include "system/regular_file.hpp"

#include <windows.h>

#include <fcntl.h>
#include <io.h>
#include <sys/stat.h>

#include <cerrno>

#include "system/windows/files.hpp"

namespace racebeam {
namespace {

bool is_directory(const std::wstring& name) {
  const DWORD attributes = GetFileAttributesW(name.c_str());
  return attributes != INVALID_FILE_ATTRIBUTES && (attributes & FILE_ATTRIBUTE_DIRECTORY) != 0;
}

// The reason to refuse an open file; empty if it is accepted.
std::string refusal_of(int descriptor) {
  struct _stat64 found {};
  if (_fstat64(descriptor, &found) != 0) return read_refusal(errno);
  switch (found.st_mode & _S_IFMT) {
    case _S_IFIFO: return "this is a pipe, not a file";
    case _S_IFCHR: return "this is a device, not a file";
    default: return {};
  }
}

}  // namespace

// A directory cannot be opened, so the kind of the file is checked before.
OpenedFile open_regular_file(const std::string& path) {
  const std::wstring name = name_of(path);
  if (is_directory(name)) return {-1, "this is a directory, not a file"};
  const int descriptor = _wopen(name.c_str(), _O_RDONLY | _O_BINARY | _O_NOINHERIT);
  if (descriptor < 0) return {-1, read_refusal(errno)};
  const std::string refusal = refusal_of(descriptor);
  if (refusal.empty()) return {descriptor, {}};
  _close(descriptor);
  return {-1, refusal};
}

std::ptrdiff_t read_from(int descriptor, std::span<char> bytes) {
  return _read(descriptor, bytes.data(), static_cast<unsigned>(bytes.size()));
}

int duplicate_descriptor(int descriptor) { return _dup(descriptor); }
void close_file(int descriptor) { _close(descriptor); }

}  // namespace racebeam
