#include "system/entropy.hpp"

#include <unistd.h>
#if defined(__APPLE__)
#include <sys/random.h>  // getentropy(), which unistd.h declares elsewhere
#endif

#include <cerrno>
#include <system_error>

namespace racebeam {

// std::random_device would need a C library of 2022 when it is linked statically, as in a wheel.
std::uint32_t random_number() {
  std::uint32_t number = 0;
  if (::getentropy(&number, sizeof number) != 0)
    throw std::system_error(errno, std::generic_category(), "no random number can be had");
  return number;
}

}  // namespace racebeam
