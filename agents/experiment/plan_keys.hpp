// The keys of a plan that are numbers, for those that read and write plans.
#pragma once

#include <array>
#include <limits>

#include "agents/experiment/plan.hpp"

namespace racebeam {

constexpr int kMaxNumberOfPlan = std::numeric_limits<int>::max();
constexpr int kMaxEpisodesOfPlan = 1000000;

struct LengthKey {
  std::string_view name;
  int TrialLength::*member;
  int least;
  int most;
};
constexpr std::array kLengthKeys = {
    LengthKey{"trials", &TrialLength::trials, 1, kMaxEpisodesOfPlan},
    LengthKey{"training_episodes", &TrialLength::training_episodes, 0, kMaxEpisodesOfPlan},
    LengthKey{"training_frames", &TrialLength::training_frames, 0, kMaxNumberOfPlan},
    LengthKey{"evaluation_episodes", &TrialLength::evaluation_episodes, 1, kMaxEpisodesOfPlan},
};

struct ScreensKey {
  std::string_view name;
  int Plan::*member;
};
constexpr std::array kScreensKeys = {ScreensKey{"background_screens", &Plan::background_screens},
                                     ScreensKey{"class_screens", &Plan::class_screens}};

}  // namespace racebeam
