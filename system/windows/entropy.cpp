#define _CRT_RAND_S  // the C library then has rand_s()
#include "system/entropy.hpp"

#include <stdlib.h>

#include <system_error>

namespace racebeam {

std::uint32_t random_number() {
  unsigned number = 0;
  if (const int error = rand_s(&number); error != 0)
    throw std::system_error(error, std::generic_category(), "no random number can be had");
  return number;
}

}  // namespace racebeam
