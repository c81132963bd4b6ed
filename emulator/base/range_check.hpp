// Checks of the fields of a state from an untrusted source. Each throws InvalidInput.
#pragma once

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "system/invalid_input.hpp"

namespace racebeam {

[[noreturn]] inline void refuse_field(const char* what, std::int64_t value, const std::string& accepted) {
  throw InvalidInput("invalid state: " + std::string(what) + " is " + std::to_string(value) +
                     "; it must be " + accepted);
}

inline void check_range(const char* what, std::int64_t value, std::int64_t least, std::int64_t most) {
  if (value >= least && value <= most) return;
  refuse_field(what, value,
               least == most ? std::to_string(least)
                             : "from " + std::to_string(least) + " to " + std::to_string(most));
}

inline void check_flag(const char* what, std::int64_t value) { check_range(what, value, 0, 1); }

// Refuses a value with a bit of `unused`, the bits that a machine never sets.
inline void check_clear(const char* what, unsigned value, unsigned unused) {
  if ((value & unused) != 0) refuse_field(what, value, "without the bits " + std::to_string(unused));
}

// Refuses padding whose bytes are not all 0.
template <class Bytes>
void check_zeros(const char* what, const Bytes& bytes) {
  for (const std::uint8_t byte : bytes) check_range(what, byte, 0, 0);
}

}  // namespace racebeam
