// Simulates scarcity, if loaded before the C library (glibc). RACEBEAM_SCARCE names a file that the test
// writes.
#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

namespace {

struct Scarcity {
  std::atomic<std::int64_t> until_failure;  // allocations; the last of them fails; 0: none
  std::atomic<std::int64_t> failures;       // of allocations, one after the other
  std::atomic<std::int64_t> alive;          // allocations that were not freed
  std::atomic<std::int64_t> threads;        // that may be started; -1: any number
};

Scarcity* scarcity = nullptr;

__attribute__((constructor)) void begin() {
  const char* const path = std::getenv("RACEBEAM_SCARCE");
  const int file = path == nullptr ? -1 : ::open(path, O_RDWR | O_CLOEXEC);
  if (file < 0) return;
  void* const page = ::mmap(nullptr, sizeof(Scarcity), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  if (page != MAP_FAILED) scarcity = static_cast<Scarcity*>(page);
  ::close(file);
}

bool fails() {
  if (scarcity == nullptr || scarcity->until_failure <= 0 || scarcity->until_failure.fetch_sub(1) != 1)
    return false;
  if (scarcity->failures.fetch_sub(1) > 1) scarcity->until_failure = 1;
  errno = ENOMEM;
  return true;
}

void count(std::int64_t more) {
  if (scarcity != nullptr) scarcity->alive += more;
}

void* counted(void* memory) {
  if (memory != nullptr) count(1);
  return memory;
}

}  // namespace

extern "C" {

void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t number, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void __libc_free(void* memory);

void* malloc(std::size_t size) { return fails() ? nullptr : counted(__libc_malloc(size)); }
void* calloc(std::size_t number, std::size_t size) {
  return fails() ? nullptr : counted(__libc_calloc(number, size));
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  return fails() ? nullptr : counted(__libc_memalign(alignment, size));
}
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) {
  *memory = aligned_alloc(alignment, size);
  return *memory == nullptr ? ENOMEM : 0;
}
void* realloc(void* memory, std::size_t size) {
  if (memory == nullptr) return malloc(size);
  if (fails()) return nullptr;
  void* const moved = __libc_realloc(memory, size);
  if (size == 0) count(-1);
  return moved;
}
void free(void* memory) {
  if (memory != nullptr) count(-1);
  __libc_free(memory);
}

using Create = int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*body)(void*),
                   void* argument) {
  static const auto create = reinterpret_cast<Create>(::dlsym(RTLD_NEXT, "pthread_create"));
  if (scarcity != nullptr && scarcity->threads >= 0 && scarcity->threads.fetch_sub(1) <= 0) {
    scarcity->threads = 0;
    return EAGAIN;
  }
  return create(thread, attributes, body, argument);
}
}
