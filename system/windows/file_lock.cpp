#include "system/file_lock.hpp"

#include <windows.h>

#include <cerrno>

#include "system/output_file.hpp"
#include "system/windows/files.hpp"

namespace racebeam {
namespace {

// Windows does not let other processes read locked bytes. So the locked byte is beyond the end of any file.
bool lock_byte(int file, DWORD how) {
  OVERLAPPED place{};
  place.OffsetHigh = 0x4000'0000;
  if (LockFileEx(handle_of(file), how, 0, 1, 0, &place) != 0) return true;
  const DWORD error = GetLastError();
  errno = error == ERROR_LOCK_VIOLATION || error == ERROR_IO_PENDING ? EWOULDBLOCK : EIO;
  return false;
}

}  // namespace

bool lock_file(int file, Waiting waiting) {
  return lock_byte(file,
                   LOCKFILE_EXCLUSIVE_LOCK | (waiting == Waiting::kYes ? 0 : LOCKFILE_FAIL_IMMEDIATELY));
}

bool is_locked_elsewhere(int error) { return error == EWOULDBLOCK; }

bool is_locked(int file) { return !lock_byte(file, LOCKFILE_FAIL_IMMEDIATELY) && is_locked_elsewhere(errno); }

int open_lock(const std::string& path) { return open_to_append(path); }

int open_lock_of_folder(const std::string&) {
  errno = ENOSYS;
  return -1;
}

bool is_at(int file, const std::string& path) {
  BY_HANDLE_FILE_INFORMATION facts{};
  if (GetFileInformationByHandle(handle_of(file), &facts) == 0) return false;
  return mark_of(path).number == (std::uint64_t{facts.nFileIndexHigh} << 32 | facts.nFileIndexLow);
}

}  // namespace racebeam
