// Cartridge schemes that are not implemented: their names, and how their images are told from others
// (docs/spec/cartridges.md, 2).
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace racebeam {

// The name of the unimplemented scheme that an image is for; empty if the image shows none.
std::string_view unsupported_scheme(const std::vector<std::uint8_t>& rom);

// Whether `name` is known as that of a scheme which is not implemented.
bool is_unsupported(std::string_view name);

}  // namespace racebeam
