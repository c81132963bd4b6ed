// What becomes of a machine of many whose episode is over, as in Gymnasium.
#pragma once

namespace racebeam {

enum class Autoreset {
  kNextStep,  // its next step resets, whatever the action
  kSameStep,  // it is reset at once; the last observation is told beside the new one
  kDisabled   // nothing moves until it is reset
};

}  // namespace racebeam
