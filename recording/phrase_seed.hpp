// Derives seeds of episodes from a published phrase, so that nobody can choose them (docs/episodes.md, "Seeds
// from a phrase").
#pragma once

#include <cstdint>
#include <string_view>

namespace racebeam {

// Throws InvalidInput for a phrase that is empty, too long, or has a quotation mark, a backslash or a control
// character.
void check_phrase(std::string_view phrase);

std::uint32_t seed_of_phrase(std::string_view phrase, std::string_view game, int trial,
                             int episode);  // from 1 to 2^31 - 1

}  // namespace racebeam
