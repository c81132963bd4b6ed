// The rows that results.csv must have, as the plan says: which of them are there, doubled or missing.
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
  // A trial of a learner with a row of divergence in `rows` has that row alone. `units` must outlive this.
  PlanRows(const std::vector<Unit>& units, const std::vector<ResultRow>& rows);

  // A row of the plan.
  struct Place {
    const Unit* unit;
    int episode;        // 0: the trial diverged
    std::size_t index;  // among all rows of the plan
  };
  std::optional<Place> find(const ResultRow& row) const;  // nothing: the plan has no such row

  bool mark(const Place& place);  // returns false if the row was marked before
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
