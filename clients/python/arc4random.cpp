// The C library's arc4random(), for the program in the wheel. Glibc has it since 2.36. The compiler's
// std::random_device, which Boost.Beast uses, calls it; so a wheel without this function would not run on an
// older system.
#include <unistd.h>

#include <cstdint>
#include <cstdlib>

extern "C" std::uint32_t arc4random() noexcept {
  std::uint32_t number = 0;
  if (getentropy(&number, sizeof number) != 0) std::abort();  // as glibc's does: it cannot be reported
  return number;
}
