#include "system/entropy.hpp"

#include <sys/random.h>

#include <cerrno>
#include <system_error>

namespace racebeam {

std::uint32_t random_number() {
  std::uint32_t number = 0;
  if (::getentropy(&number, sizeof number) != 0)
    throw std::system_error(errno, std::generic_category(), "no random number can be had");
  return number;
}

}  // namespace racebeam
