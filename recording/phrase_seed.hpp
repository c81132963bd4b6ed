// Derives seeds of episodes from a published phrase, so that nobody can choose them (docs/episodes.md, "Seeds
// from a phrase").
#pragma once

#include <cstdint>
#include <string_view>

namespace racebeam {

// What a phrase has.
constexpr std::string_view kPhraseRule =
    "1 to 1000 bytes, without quotation marks, backslashes and control characters";

bool is_phrase(std::string_view text);
void check_phrase(std::string_view phrase);  // throws InvalidInput

// The seed of an episode, from 1 to 2^31 - 1.
std::uint32_t seed_of_phrase(std::string_view phrase, std::string_view game, int trial, int episode);

}  // namespace racebeam
