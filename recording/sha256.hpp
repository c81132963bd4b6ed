// SHA-256 (FIPS 180-4), which identifies files by their contents.
#pragma once

#include <string>
#include <string_view>

namespace racebeam {

// The SHA-256 of bytes, or of a file of any size, in lower-case hex. `what` begins the message of the
// InvalidInput that is thrown for a file that cannot be read.
std::string sha256_of(std::string_view bytes);
std::string sha256_of_file(const std::string& what, const std::string& path);

}  // namespace racebeam
