#include "system/linux/files.hpp"

#include <fcntl.h>
#include <stdio.h>
#include <unistd.h>

namespace racebeam {

// The mark is a flag that tells backup programs to leave out the file. macOS cannot make a file with the
// sticky bit.
const mode_t kModeOfMarked = 0644;
void mark(int file) { ::fchflags(file, UF_NODUMP); }
void unmark(int file, const struct stat& facts) { ::fchflags(file, facts.st_flags & ~__uint32_t{UF_NODUMP}); }
bool is_marked(const struct stat& facts) { return (facts.st_flags & UF_NODUMP) != 0; }

timespec changed_at(const struct stat& facts) { return facts.st_mtimespec; }

// After fsync(), the bytes may still be in the disk's cache. Some file systems do not support F_FULLFSYNC.
bool sync_bytes(int file) { return ::fcntl(file, F_FULLFSYNC) == 0 || ::fsync(file) == 0; }
bool sync_disk(int file) { return ::fsync_volume_np(file, SYNC_VOLUME_FULLSYNC | SYNC_VOLUME_WAIT) == 0; }

bool rename_if_new(const char* from, const char* to) { return ::renamex_np(from, to, RENAME_EXCL) == 0; }

}  // namespace racebeam
