// Base64 as in RFC 4648, section 4, with padding.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace racebeam {

void append_base64(std::string& out, std::span<const std::uint8_t> bytes);

// Returns nothing if the text is not base64: another letter, a length that is not a multiple of 4, padding
// inside.
std::optional<std::vector<std::uint8_t>> bytes_of_base64(std::string_view text);

}  // namespace racebeam
