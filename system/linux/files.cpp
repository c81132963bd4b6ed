#include "system/linux/files.hpp"

#include <fcntl.h>
#include <stdio.h>
#include <unistd.h>

namespace racebeam {

// The sticky bit does not have a meaning for a file.
const mode_t kModeOfMarked = S_ISVTX | 0644;
void mark(int) {}
void unmark(int file, const struct stat& facts) { ::fchmod(file, facts.st_mode & 0777); }
bool is_marked(const struct stat& facts) { return (facts.st_mode & S_ISVTX) != 0; }

timespec changed_at(const struct stat& facts) { return facts.st_mtim; }

bool sync_bytes(int file) { return ::fsync(file) == 0; }
bool sync_disk(int file) { return ::syncfs(file) == 0; }

bool rename_if_new(const char* from, const char* to) {
#if defined(RENAME_NOREPLACE)
  return ::renameat2(AT_FDCWD, from, AT_FDCWD, to, RENAME_NOREPLACE) == 0;
#else
  return ::link(from, to) == 0 && ::unlink(from) == 0;
#endif
}

}  // namespace racebeam
