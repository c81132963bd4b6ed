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

/// What bytes are written in where the client does not say.
inline constexpr std::array<std::pair<std::string_view, Encoding>, 9> kUsual{{{"ram", Encoding::kHex}, {"tia", Encoding::kHex}, {"state_hash", Encoding::kHex}, {"screen", Encoding::kRle}, {"rgb", Encoding::kZlib}, {"grey", Encoding::kZlib}, {"palette", Encoding::kHex}, {"audio", Encoding::kHex}, {"audio_all", Encoding::kHex}}};
/// Bytes of fields that always have the same number.
inline constexpr std::array<std::pair<std::string_view, std::size_t>, 5> kSizes{{{"ram", 128}, {"tia", 53}, {"state_hash", 8}, {"palette", 768}, {"audio", 512}}};
/// Bytes of a pixel of fields that have the size of the screen.
inline constexpr std::array<std::pair<std::string_view, std::size_t>, 3> kPixels{{{"screen", 1}, {"rgb", 3}, {"grey", 1}}};

}  // namespace RACEBEAM_CLIENT_NAMESPACE::detail
