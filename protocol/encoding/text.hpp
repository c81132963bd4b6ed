// Reads numbers from a client's line, and writes memory and screens as text.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "emulator/base/simd.hpp"

namespace racebeam {

// Parses as C's atoi does: leading blanks, a sign, digits. The rest is ignored; without digits, the result
// is 0. The result saturates.
int parse_integer(std::string_view text);

// Splits `line` at commas, skips empty parts, and reads as many of the others as fit into `values`. Returns
// their number.
std::size_t parse_integers(std::string_view line, std::span<int> values);

// Two digits for each byte, high first, upper case. All variants give the same text; see hex_text.cpp.
void append_hex(std::string& out, std::span<const std::uint8_t> bytes, Simd form = simd());

// Colour and length of each run, two digits each. Runs continue across rows; 255 is the longest. All variants
// give the same text; see run_length_text.cpp.
void append_run_length(std::string& out, std::span<const std::uint8_t> pixels, Simd form = simd());

}  // namespace racebeam
