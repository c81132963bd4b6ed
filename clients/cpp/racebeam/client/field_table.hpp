// Made from protocol/protocol.toml by protocol/description/generate. Do not change it by hand.
// clang-format off
#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <utility>

#include "racebeam/client/config.hpp"
#include "racebeam/client/encoding.hpp"

namespace RACEBEAM_CLIENT_NAMESPACE::detail {

/// The encodings of fields of bytes where a request does not name one.
inline constexpr std::array<std::pair<std::string_view, Encoding>, 9> kUsual{{
    {"ram", Encoding::kHex},
    {"tia", Encoding::kHex},
    {"state_hash", Encoding::kHex},
    {"screen", Encoding::kRle},
    {"rgb", Encoding::kZlib},
    {"grey", Encoding::kZlib},
    {"palette", Encoding::kHex},
    {"audio", Encoding::kHex},
    {"audio_all", Encoding::kHex},
}};
/// The sizes in bytes of fields whose size never changes.
inline constexpr std::array<std::pair<std::string_view, std::size_t>, 5> kSizes{{
    {"ram", 128},
    {"tia", 53},
    {"state_hash", 8},
    {"palette", 768},
    {"audio", 512},
}};
/// Bytes per pixel of fields with the size of the screen.
inline constexpr std::array<std::pair<std::string_view, std::size_t>, 3> kPixels{{
    {"screen", 1},
    {"rgb", 3},
    {"grey", 1},
}};

}  // namespace RACEBEAM_CLIENT_NAMESPACE::detail
