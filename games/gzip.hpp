// Reads gzip files.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

namespace racebeam {

bool is_gzip(std::string_view bytes);

// The contents of all members, or the first `most` + 1 bytes of them. Data after the members is ignored.
// Throws InvalidInput if the file is truncated or damaged.
std::vector<std::uint8_t> gunzip(std::string_view file, std::size_t most);

}  // namespace racebeam
