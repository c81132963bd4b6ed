#include "system/windows/files.hpp"

#include <windows.h>

#include <io.h>

#include <cerrno>

namespace racebeam {
namespace {

constexpr auto kVerbatim = L"\\\\?\\";  // before a path that may be longer than MAX_PATH

std::wstring wide(const std::string& path) {
  const int size = static_cast<int>(path.size());
  std::wstring letters(path.size(), L'\0');
  letters.resize(
      static_cast<std::size_t>(MultiByteToWideChar(CP_UTF8, 0, path.data(), size, letters.data(), size)));
  return letters;
}

}  // namespace

std::wstring name_of(const std::string& path) {
  const std::wstring name = wide(path);
  if (name.size() < MAX_PATH || name.starts_with(L"\\\\")) return name;
  std::wstring whole(GetFullPathNameW(name.c_str(), 0, nullptr, nullptr), L'\0');
  whole.resize(GetFullPathNameW(name.c_str(), static_cast<DWORD>(whole.size()), whole.data(), nullptr));
  return kVerbatim + whole;
}

void* handle_of(int file) { return reinterpret_cast<HANDLE>(_get_osfhandle(file)); }

int reason_of(unsigned long error) {
  switch (error) {
    case ERROR_FILE_NOT_FOUND:
    case ERROR_PATH_NOT_FOUND: return ENOENT;
    case ERROR_FILE_EXISTS:
    case ERROR_ALREADY_EXISTS: return EEXIST;
    case ERROR_ACCESS_DENIED:
    case ERROR_SHARING_VIOLATION:
    case ERROR_LOCK_VIOLATION: return EACCES;
    case ERROR_DISK_FULL: return ENOSPC;
    case ERROR_DIRECTORY: return ENOTDIR;
    case ERROR_DIR_NOT_EMPTY: return ENOTEMPTY;
    case ERROR_FILENAME_EXCED_RANGE:
    case ERROR_INVALID_NAME: return EINVAL;
    default: return EIO;
  }
}

}  // namespace racebeam
