// The one place that reads numbers from a client's line and writes memory and screens as text.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "emulator/base/simd.hpp"

namespace racebeam {

// Reads as C's atoi: leading blanks, a sign, digits; the rest is ignored; no digits give 0. Saturates.
int parse_integer(std::string_view text);

// Cuts `line` at commas, skips empty parts and reads the first of the others into `values`. Returns how many.
std::size_t parse_integers(std::string_view line, std::span<int> values);

// Two digits a byte, high first, upper case. All forms give the same text; see hex_text.cpp.
void append_hex(std::string& out, std::span<const std::uint8_t> bytes, Simd form = simd());

// Colour and length of each run, two digits each. Runs go on across rows; 255 is the longest. All forms give
// the same text; see run_length_text.cpp.
void append_run_length(std::string& out, std::span<const std::uint8_t> pixels, Simd form = simd());

}  // namespace racebeam
