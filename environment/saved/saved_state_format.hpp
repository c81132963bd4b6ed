// A saved state as bytes that another process can restore: magic, version, sizes, checksum, the image's MD5,
// the game's name, then the values of Saved.
//
// The trivially copyable values are written whole, not field by field: they are integers of fixed width and
// single floats, little-endian, without padding, so that their memory is already a portable form, and no list
// of fields can drift from them. Whoever changes one of these types raises kSnapshotVersion; their size is
// checked as well.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "environment/environment.hpp"

namespace racebeam {

constexpr std::uint32_t kSnapshotVersion = 2;

// `environment` draws the pictures if they are not yet (Environment::set_drawing); it is one that could restore the state,
// else InvalidInput is thrown, and is left as it was.
std::vector<std::uint8_t> to_bytes(const Environment::Saved& saved, const Environment& environment);

// Throws InvalidInput when `bytes` are no state, were cut or altered, are of another version of this
// program, or of another image or game than those of `environment`, or when a value in them is none that the
// machine can have. Whoever wrote the bytes: the state that is returned can be restored and run.
std::shared_ptr<const Environment::Saved> from_bytes(std::span<const std::uint8_t> bytes,
                                                     const Environment& environment);

}  // namespace racebeam
