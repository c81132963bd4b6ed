// Contents in a sealed file: deflated, with a checksum that covers every byte (docs/episodes.md, "The seal").
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace racebeam {

// The kind of a sealed file.
struct SealedKind {
  std::string_view what;   // for errors: "episode log"
  std::string_view magic;  // eight characters
  std::uint32_t version;
  std::size_t most;  // the most bytes of the contents, and of the file
  int level;         // of deflate, 1 to 9
};

// Returns the bytes of the sealed file. Calls `pause`, if not empty, about every millisecond; it may throw.
// Throws std::runtime_error for more than kind.most bytes.
std::string seal(const SealedKind& kind, std::string_view contents, const std::function<void()>& pause = {});

// Returns the contents. Throws InvalidInput, which names `name`, for bytes that seal() did not produce:
// another kind or version, a file that was cut or altered, or contents of more than kind.most bytes.
std::string unseal(const SealedKind& kind, const std::string& name, std::string_view bytes);

std::string read_sealed(const SealedKind& kind, const std::string& path);  // throws InvalidInput

}  // namespace racebeam
