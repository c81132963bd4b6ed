// Simulates a hanging disk, if loaded before the C library: fsync never returns.
#include <unistd.h>

extern "C" int fsync(int) {
  for (;;) pause();
}

extern "C" int syncfs(int descriptor) noexcept { return fsync(descriptor); }
