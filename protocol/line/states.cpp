#include "protocol/line/states.hpp"

#include <utility>

namespace racebeam {

const Slot::Saved* States::find(std::string_view name) const {
  const auto found = by_name_.find(name);
  return found == by_name_.end() ? nullptr : &found->second;
}

void States::put(std::string_view name, Slot::Saved place) {
  drop(name);
  footprint_ += place.footprint();
  by_name_.emplace(name, std::move(place));
}

void States::drop(std::string_view name) {
  const auto found = by_name_.find(name);
  if (found == by_name_.end()) return;
  footprint_ -= found->second.footprint();
  by_name_.erase(found);
}

}  // namespace racebeam
