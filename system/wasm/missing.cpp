// Functions that Emscripten declares, but does not define. Both fail, as on a system without them.
#include <spawn.h>
#include <unistd.h>

#include <cerrno>

extern "C" {

int posix_spawnp(pid_t*, const char*, const posix_spawn_file_actions_t*, const posix_spawnattr_t*,
                 char* const*, char* const*) {
  return ENOSYS;
}

int syncfs(int) {
  errno = ENOSYS;
  return -1;
}

}  // extern "C"
