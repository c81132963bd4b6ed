// Names of cartridge schemes that are not implemented (docs/spec/cartridges.md, 2).
#pragma once

#include <span>
#include <string_view>

namespace racebeam {

std::span<const std::string_view> unsupported_schemes();

// Whether `name` is one of them.
bool is_unsupported(std::string_view name);

}  // namespace racebeam
