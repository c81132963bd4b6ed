// What the sessions of a server share beside images: cached resets, and translated code.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace racebeam {

struct SharedCaches {
  std::uint64_t bytes;        // of both, for the memory budget
  std::size_t resets;         // entries
  std::size_t code_of_image;  // bytes of translated code for one image
  std::size_t code;           // of all images, but for those that clients send
};

// The sizes for a server that may use this much memory: a sixteenth of it, and no more than is useful.
// 0: no limit.
SharedCaches shared_caches_for(std::uint64_t memory);

// Applies to the whole process. Call it before images are translated.
void use(const SharedCaches& caches);

// For the log, such as "128 resets, 4194304 bytes of code for an image, 15728640 for all".
std::string text_of(const SharedCaches& caches);

}  // namespace racebeam
