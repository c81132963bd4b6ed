// The rows that results.csv must have according to the plan. Finds which of them exist, occur twice, or are
// missing.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "agents/experiment/results.hpp"

namespace racebeam {

class PlanRows {
 public:
  explicit PlanRows(const std::vector<Unit>& units);  // `units` must outlive this

  // Must be called with every row before the first find(), since a trial that diverged has only one row.
  void note(const ResultRow& row);

  // A row of the plan.
  struct Place {
    const Unit* unit;
    int episode;        // 0: the trial diverged
    std::size_t index;  // among all rows of the plan
  };
  std::optional<Place> find(std::string_view unit, std::string_view episode) const;  // nothing: no such row

  bool has(std::string_view unit) const { return by_name_.contains(unit); }
  bool mark(const Place& place);                 // returns false if the row was marked before
  bool has_marked(std::string_view unit) const;  // any row of a unit of the plan
  bool is_marked(const Place& place) const { return marked_[place.index]; }
  void each_unmarked(const std::function<void(const Unit& unit, int episode)>& visit) const;

 private:
  struct Own {
    const Unit* unit;
    bool diverged = false;
    std::size_t first = 0;  // the index of its first row

    std::size_t rows() const;
  };

  std::vector<Own> own_;  // in the plan's order
  std::unordered_map<std::string_view, std::size_t> by_name_;
  std::vector<bool> marked_;
};

}  // namespace racebeam
