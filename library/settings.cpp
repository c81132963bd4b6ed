#include "library/internals.hpp"

namespace racebeam::v0 {
namespace {

racebeam::Rules internal(Rules rules) {
  return rules == Rules::kFixed ? racebeam::Rules::kFixed : racebeam::Rules::kAle012;
}

CpuKind internal(Cpu cpu) {
  switch (cpu) {
    case Cpu::kInterpreter: return CpuKind::kInterpreter;
    case Cpu::kTranslator: return CpuKind::kTranslator;
    default: return CpuKind::kAuto;
  }
}

}  // namespace

racebeam::Settings internal(const Settings& settings) {
  return {.rules = internal(settings.rules),
          .random_seed = settings.seed,
          .system_seed = settings.system_seed,
          .frame_skip = settings.frame_skip,
          .frame_skip_max = settings.frame_skip_max,
          .sticky = settings.sticky,
          .max_episode_frames = settings.max_episode_frames,
          .truncate_on_life_loss = settings.truncate_on_life_loss,
          .reward_min = settings.reward_min,
          .reward_max = settings.reward_max,
          .color_averaging = settings.color_averaging,
          .sound = settings.sound,
          .paddle_min = settings.paddle_min,
          .paddle_max = settings.paddle_max,
          .cpu = internal(settings.cpu)};
}

}  // namespace racebeam::v0
