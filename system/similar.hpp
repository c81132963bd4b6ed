// Suggestions for unknown names.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace racebeam {

// The `candidates` most similar to `name`: nearest first, at most three. Empty if none is similar. Case does
// not matter.
std::vector<std::string_view> similar_names(std::string_view name,
                                            std::span<const std::string_view> candidates);

// For error messages: " did you mean A or B?", or "" if none is similar.
std::string did_you_mean(std::string_view name, std::span<const std::string_view> candidates);

}  // namespace racebeam
