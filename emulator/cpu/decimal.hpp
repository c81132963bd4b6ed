// Decimal addition and subtraction as in the reference, including invalid digits (docs/spec/cpu.md, 8).
#pragma once

#include <cstdint>

namespace racebeam {

struct DecimalResult {
  std::uint8_t value;
  std::uint8_t carry;
};

constexpr int from_bcd(int byte) { return 10 * (byte >> 4) + (byte & 15); }

constexpr std::uint8_t to_bcd(int number) {
  return static_cast<std::uint8_t>(16 * (number % 100 / 10) + number % 10);
}

constexpr DecimalResult add_decimal(int a, int m, int carry) {
  const int sum = from_bcd(a) + from_bcd(m) + carry;
  return {to_bcd(sum & 0xFF), static_cast<std::uint8_t>(sum > 99)};  // sums of 256 and more lose 256
}

constexpr DecimalResult subtract_decimal(int a, int m, int carry) {
  const int borrow = 1 - carry;
  int difference = from_bcd(a) - from_bcd(m) - borrow;
  if (difference < 0) difference += 100;
  const std::uint8_t value =
      difference >= 0 ? to_bcd(difference) : static_cast<std::uint8_t>(from_bcd(256 + difference));
  return {value, static_cast<std::uint8_t>(a >= m + borrow)};
}

}  // namespace racebeam
