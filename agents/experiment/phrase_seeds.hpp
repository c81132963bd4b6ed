// Results whose seeds must follow from a published phrase (docs/episodes.md, "Seeds from a phrase").
#pragma once

#include <functional>
#include <map>
#include <string>
#include <utility>

#include "agents/experiment/results.hpp"

namespace racebeam {

// Judges the rows of such results.
class PhraseRows {
 public:
  explicit PhraseRows(std::string phrase) : phrase_(std::move(phrase)) {}

  // Returns a sentence if the seed of a row, or its place among the rows, is wrong; otherwise an empty text.
  std::string fault(const ResultRow& row);

  // Called after all rows. Visits a sentence about each missing episode, which may have been left out for its
  // score.
  void each_gap(const std::function<void(const std::string& sentence)>& visit) const;

 private:
  struct Episodes {
    std::string unit;
    int count = 0, last = 0;
  };

  std::string phrase_;
  std::map<std::pair<std::string, int>, Episodes> trials_;  // by game and trial
};

}  // namespace racebeam
