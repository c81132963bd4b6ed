#include "agents/experiment/plan_rows.hpp"

#include <algorithm>

#include "system/words.hpp"

namespace racebeam {

std::size_t PlanRows::Own::rows() const {
  return diverged ? 1 : static_cast<std::size_t>(unit->agent->length.evaluation_episodes);
}

PlanRows::PlanRows(const std::vector<Unit>& units) {
  own_.reserve(units.size());
  std::size_t count = 0;
  for (const Unit& unit : units) {
    by_name_.emplace(unit.name, own_.size());
    own_.push_back({.unit = &unit, .first = count});
    count += std::max<std::size_t>(own_.back().rows(), 1);  // it may have diverged
  }
  marked_.resize(count);
}

void PlanRows::note(const ResultRow& row) {
  if (field(row, "end") != "diverged") return;
  const auto found = by_name_.find(row[0]);
  if (found == by_name_.end()) return;
  Own& own = own_[found->second];
  own.diverged = own.unit->agent->kind->role == Role::kLearner;
}

std::optional<PlanRows::Place> PlanRows::find(std::string_view unit, std::string_view text) const {
  const auto found = by_name_.find(unit);
  const auto episode = parse_number<int>(text);
  if (found == by_name_.end() || !episode || std::to_string(*episode) != text) return std::nullopt;
  const Own& own = own_[found->second];
  const int first = own.diverged ? 0 : 1;
  if (*episode < first || static_cast<std::size_t>(*episode - first) >= own.rows()) return std::nullopt;
  return Place{own.unit, *episode, own.first + static_cast<std::size_t>(*episode - first)};
}

bool PlanRows::mark(const Place& place) {
  if (marked_[place.index]) return false;
  marked_[place.index] = true;
  return true;
}

bool PlanRows::has_marked(std::string_view unit) const {
  const Own& own = own_[by_name_.at(unit)];
  const auto first = marked_.begin() + static_cast<std::ptrdiff_t>(own.first);
  return std::find(first, first + static_cast<std::ptrdiff_t>(own.rows()), true) !=
         first + static_cast<std::ptrdiff_t>(own.rows());
}

void PlanRows::each_unmarked(const std::function<void(const Unit& unit, int episode)>& visit) const {
  for (const Own& own : own_)
    for (std::size_t i = 0; i < own.rows(); ++i)
      if (!marked_[own.first + i]) visit(*own.unit, static_cast<int>(i) + (own.diverged ? 0 : 1));
}

}  // namespace racebeam
