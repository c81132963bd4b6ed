// What a person may have meant who wrote a name that is not there.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace racebeam {

// Those of `known` that are most like `name`, nearest first, three at most; none if nothing is near. Whether
// letters are large or small does not count.
std::vector<std::string_view> similar_names(std::string_view name, std::span<const std::string_view> known);

// For sentences: " did you mean A or B?", or "" if nothing is near.
std::string did_you_mean(std::string_view name, std::span<const std::string_view> known);

}  // namespace racebeam
