#include "cli/commands/shared_caches.hpp"

#include <algorithm>

#include "emulator/translator/code_owner.hpp"
#include "emulator/translator/translator.hpp"
#include "environment/reset/reset_cache.hpp"

namespace racebeam {

SharedCaches shared_caches_for(std::uint64_t memory) {
  constexpr std::uint64_t kMax = 24 << 20, kReset = 72 << 10;
  constexpr std::uint64_t kMinCode = 128 << 10, kMaxCode = 4 << 20;
  const std::uint64_t bytes = memory == 0 ? kMax : std::min(memory / 16, kMax);
  const std::uint64_t resets = std::clamp<std::uint64_t>(bytes / 2 / kReset, 1, ResetCache::kMax);
  return {bytes, resets, std::clamp(bytes / 6, kMinCode, kMaxCode), bytes - resets * kReset};
}

void use(const SharedCaches& caches) {
  reset_cache().set_capacity(caches.resets);
  Translator::set_code_capacity(caches.code_of_image);
  limit_shared_code(caches.code);
}

std::string text_of(const SharedCaches& caches) {
  return std::to_string(caches.resets) + " resets, " + std::to_string(caches.code_of_image) +
         " bytes of code for an image, " + std::to_string(caches.code) + " for all";
}

}  // namespace racebeam
