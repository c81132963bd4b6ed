// Functions of newer C libraries (glibc), implemented with those of glibc 2.28. A Python module with this
// source loads on any Linux system since 2018, wherever it was built. The library keeps old versions of a
// function, such as pthread_create@GLIBC_2.2.5.
#include <features.h>
#if defined __GLIBC__ && (defined __x86_64__ || defined __aarch64__)
#if __GLIBC_PREREQ(2, 34)
#include <fcntl.h>
#include <pthread.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <ctime>

#ifdef __x86_64__
#define FIRST_VERSION "@GLIBC_2.2.5"
#define WITH_SIZE_OF_SET "@GLIBC_2.3.4"
#else
#define FIRST_VERSION "@GLIBC_2.17"
#define WITH_SIZE_OF_SET FIRST_VERSION
#endif

extern "C" {
// 2.34: threads are in libc.so.6, and their functions have new versions.
#define OLD_VERSION(name, version) __asm__(".symver old_" #name ", " #name version)
OLD_VERSION(pthread_create, FIRST_VERSION);
OLD_VERSION(pthread_join, FIRST_VERSION);
OLD_VERSION(pthread_mutex_trylock, FIRST_VERSION);
OLD_VERSION(pthread_once, FIRST_VERSION);
OLD_VERSION(pthread_setaffinity_np, WITH_SIZE_OF_SET);

int old_pthread_create(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
int old_pthread_join(pthread_t, void**);
int old_pthread_mutex_trylock(pthread_mutex_t*);
int old_pthread_once(pthread_once_t*, void (*)());
int old_pthread_setaffinity_np(pthread_t, std::size_t, const cpu_set_t*);

int pthread_create(pthread_t* thread, const pthread_attr_t* with, void* (*run)(void*), void* data) noexcept {
  return old_pthread_create(thread, with, run, data);
}
int pthread_join(pthread_t thread, void** result) { return old_pthread_join(thread, result); }
int pthread_mutex_trylock(pthread_mutex_t* mutex) noexcept { return old_pthread_mutex_trylock(mutex); }
int pthread_once(pthread_once_t* once, void (*run)()) { return old_pthread_once(once, run); }
int pthread_setaffinity_np(pthread_t thread, std::size_t size, const cpu_set_t* set) noexcept {
  return old_pthread_setaffinity_np(thread, size, set);
}

// 2.33: these are functions of the library. The structures are the kernel's.
int stat(const char* path, struct stat* to) noexcept {
  return static_cast<int>(syscall(SYS_newfstatat, AT_FDCWD, path, to, 0));
}
int lstat(const char* path, struct stat* to) noexcept {
  return static_cast<int>(syscall(SYS_newfstatat, AT_FDCWD, path, to, AT_SYMLINK_NOFOLLOW));
}
int fstat(int file, struct stat* to) noexcept { return static_cast<int>(syscall(SYS_fstat, file, to)); }
int fstat64(int file, struct stat64* to) noexcept { return static_cast<int>(syscall(SYS_fstat, file, to)); }

// 2.32: whether the process has only one thread, so that reference counters work without atomic instructions.
extern char __libc_single_threaded;  // NOLINT(bugprone-reserved-identifier): the library's name
char __libc_single_threaded = 0;     // NOLINT(bugprone-reserved-identifier)

// 2.30: waits until a time of this clock. This version waits by the real-time clock, and goes on waiting if
// that was set forward.
int pthread_cond_clockwait(pthread_cond_t* condition, pthread_mutex_t* mutex, clockid_t clock,
                           const timespec* until) {
  const auto time_of = [](clockid_t which) {
    timespec now{};
    clock_gettime(which, &now);
    return now;
  };
  constexpr std::int64_t kSecond = 1'000'000'000;
  for (;;) {
    const timespec now = time_of(clock), day = time_of(CLOCK_REALTIME);
    const std::int64_t rest = (until->tv_sec - now.tv_sec) * kSecond + until->tv_nsec - now.tv_nsec;
    if (rest <= 0) return ETIMEDOUT;
    const std::int64_t fraction = day.tv_nsec + rest;
    const timespec deadline{day.tv_sec + fraction / kSecond, fraction % kSecond};
    if (const int error = pthread_cond_timedwait(condition, mutex, &deadline); error != ETIMEDOUT)
      return error;
  }
}
}
#endif
#endif
