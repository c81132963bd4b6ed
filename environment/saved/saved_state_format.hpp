// A saved state as bytes that another process can restore: magic, version, sizes, checksum, the image's MD5,
// the game's name, then the values of Saved.
//
// The trivially copyable values are written as their memory, not field by field: integers of fixed width and
// single floats, little-endian, without padding. Their memory is therefore portable, and no list of fields
// can become outdated. A change to one of these types must increment kSnapshotVersion; their sizes are
// checked as well.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "environment/environment.hpp"

namespace racebeam {

constexpr std::uint32_t kSnapshotVersion = 2;

// `environment` draws the pictures if they are deferred (Environment::set_drawing). It must be able to
// restore the state, else InvalidInput is thrown; it is not changed.
std::vector<std::uint8_t> to_bytes(const Environment::Saved& saved, const Environment& environment);

// Throws InvalidInput if `bytes` are not a state, were truncated or altered, or come from another version of
// racebeam. It also throws if they belong to another image or game than `environment`, or contain a value
// that the machine cannot have. A returned state can be restored and run, whatever its source.
std::shared_ptr<const Environment::Saved> from_bytes(std::span<const std::uint8_t> bytes,
                                                     const Environment& environment);

}  // namespace racebeam
