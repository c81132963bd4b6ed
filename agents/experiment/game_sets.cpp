#include "agents/experiment/game_sets.hpp"

#include <algorithm>
#include <array>

namespace racebeam {
namespace {

// Bellemare et al. 2013, the table of appendix D, in its order and with its names. The paper spells Ms.
// Pac-Man "Ms. Pacman", too.
constexpr std::array kPaper = {
    SetGame{"asterix", "Asterix"},
    SetGame{"beam_rider", "Beam Rider"},
    SetGame{"freeway", "Freeway"},
    SetGame{"seaquest", "Seaquest"},
    SetGame{"space_invaders", "Space Invaders"},
    SetGame{"alien", "Alien"},
    SetGame{"amidar", "Amidar"},
    SetGame{"assault", "Assault"},
    SetGame{"asteroids", "Asteroids"},
    SetGame{"atlantis", "Atlantis"},
    SetGame{"bank_heist", "Bank Heist"},
    SetGame{"battle_zone", "Battle Zone"},
    SetGame{"berzerk", "Berzerk"},
    SetGame{"bowling", "Bowling"},
    SetGame{"boxing", "Boxing"},
    SetGame{"breakout", "Breakout"},
    SetGame{"carnival", "Carnival"},
    SetGame{"centipede", "Centipede"},
    SetGame{"chopper_command", "Chopper Command"},
    SetGame{"crazy_climber", "Crazy Climber"},
    SetGame{"demon_attack", "Demon Attack"},
    SetGame{"double_dunk", "Double Dunk"},
    SetGame{"elevator_action", "Elevator Action"},
    SetGame{"enduro", "Enduro"},
    SetGame{"fishing_derby", "Fishing Derby"},
    SetGame{"frostbite", "Frostbite"},
    SetGame{"gopher", "Gopher"},
    SetGame{"gravitar", "Gravitar"},
    SetGame{"hero", "H.E.R.O."},
    SetGame{"ice_hockey", "Ice Hockey"},
    SetGame{"jamesbond", "James Bond"},
    SetGame{"journey_escape", "Journey Escape"},
    SetGame{"kangaroo", "Kangaroo"},
    SetGame{"krull", "Krull"},
    SetGame{"kung_fu_master", "Kung-Fu Master"},
    SetGame{"montezuma_revenge", "Montezuma's Revenge"},
    SetGame{"ms_pacman", "Ms. Pac-Man"},
    SetGame{"name_this_game", "Name This Game"},
    SetGame{"pooyan", "Pooyan"},
    SetGame{"pong", "Pong"},
    SetGame{"private_eye", "Private Eye"},
    SetGame{"qbert", "Q*Bert"},
    SetGame{"riverraid", "River Raid"},
    SetGame{"road_runner", "Road Runner"},
    SetGame{"robotank", "Robotank"},
    SetGame{"skiing", "Skiing"},
    SetGame{"star_gunner", "Star Gunner"},
    SetGame{"tennis", "Tennis"},
    SetGame{"time_pilot", "Time Pilot"},
    SetGame{"tutankham", "Tutankham"},
    SetGame{"up_n_down", "Up and Down"},
    SetGame{"venture", "Venture"},
    SetGame{"video_pinball", "Video Pinball"},
    SetGame{"wizard_of_wor", "Wizard of Wor"},
    SetGame{"zaxxon", "Zaxxon"},
};
constexpr std::size_t kTrainingGames = 5;

// Kaiser et al. 2020, "Model-Based Reinforcement Learning for Atari".
constexpr std::array kAtari100k = {
    SetGame{"alien", "Alien"},
    SetGame{"amidar", "Amidar"},
    SetGame{"assault", "Assault"},
    SetGame{"asterix", "Asterix"},
    SetGame{"bank_heist", "BankHeist"},
    SetGame{"battle_zone", "BattleZone"},
    SetGame{"boxing", "Boxing"},
    SetGame{"breakout", "Breakout"},
    SetGame{"chopper_command", "ChopperCommand"},
    SetGame{"crazy_climber", "CrazyClimber"},
    SetGame{"demon_attack", "DemonAttack"},
    SetGame{"freeway", "Freeway"},
    SetGame{"frostbite", "Frostbite"},
    SetGame{"gopher", "Gopher"},
    SetGame{"hero", "Hero"},
    SetGame{"jamesbond", "Jamesbond"},
    SetGame{"kangaroo", "Kangaroo"},
    SetGame{"krull", "Krull"},
    SetGame{"kung_fu_master", "KungFuMaster"},
    SetGame{"ms_pacman", "MsPacman"},
    SetGame{"pong", "Pong"},
    SetGame{"private_eye", "PrivateEye"},
    SetGame{"qbert", "Qbert"},
    SetGame{"road_runner", "RoadRunner"},
    SetGame{"seaquest", "Seaquest"},
    SetGame{"up_n_down", "UpNDown"},
};

// The 57 games of Wang et al. 2016, "Dueling Network Architectures for Deep Reinforcement Learning", which
// later papers report. All are in the catalogue.
constexpr std::array kAtari57 = {
    SetGame{"alien", "Alien"},
    SetGame{"amidar", "Amidar"},
    SetGame{"assault", "Assault"},
    SetGame{"asterix", "Asterix"},
    SetGame{"asteroids", "Asteroids"},
    SetGame{"atlantis", "Atlantis"},
    SetGame{"bank_heist", "BankHeist"},
    SetGame{"battle_zone", "BattleZone"},
    SetGame{"beam_rider", "BeamRider"},
    SetGame{"berzerk", "Berzerk"},
    SetGame{"bowling", "Bowling"},
    SetGame{"boxing", "Boxing"},
    SetGame{"breakout", "Breakout"},
    SetGame{"centipede", "Centipede"},
    SetGame{"chopper_command", "ChopperCommand"},
    SetGame{"crazy_climber", "CrazyClimber"},
    SetGame{"defender", "Defender"},
    SetGame{"demon_attack", "DemonAttack"},
    SetGame{"double_dunk", "DoubleDunk"},
    SetGame{"enduro", "Enduro"},
    SetGame{"fishing_derby", "FishingDerby"},
    SetGame{"freeway", "Freeway"},
    SetGame{"frostbite", "Frostbite"},
    SetGame{"gopher", "Gopher"},
    SetGame{"gravitar", "Gravitar"},
    SetGame{"hero", "Hero"},
    SetGame{"ice_hockey", "IceHockey"},
    SetGame{"jamesbond", "Jamesbond"},
    SetGame{"kangaroo", "Kangaroo"},
    SetGame{"krull", "Krull"},
    SetGame{"kung_fu_master", "KungFuMaster"},
    SetGame{"montezuma_revenge", "MontezumaRevenge"},
    SetGame{"ms_pacman", "MsPacman"},
    SetGame{"name_this_game", "NameThisGame"},
    SetGame{"phoenix", "Phoenix"},
    SetGame{"pitfall", "Pitfall"},
    SetGame{"pong", "Pong"},
    SetGame{"private_eye", "PrivateEye"},
    SetGame{"qbert", "Qbert"},
    SetGame{"riverraid", "Riverraid"},
    SetGame{"road_runner", "RoadRunner"},
    SetGame{"robotank", "Robotank"},
    SetGame{"seaquest", "Seaquest"},
    SetGame{"skiing", "Skiing"},
    SetGame{"solaris", "Solaris"},
    SetGame{"space_invaders", "SpaceInvaders"},
    SetGame{"star_gunner", "StarGunner"},
    SetGame{"surround", "Surround"},
    SetGame{"tennis", "Tennis"},
    SetGame{"time_pilot", "TimePilot"},
    SetGame{"tutankham", "Tutankham"},
    SetGame{"up_n_down", "UpNDown"},
    SetGame{"venture", "Venture"},
    SetGame{"video_pinball", "VideoPinball"},
    SetGame{"wizard_of_wor", "WizardOfWor"},
    SetGame{"yars_revenge", "YarsRevenge"},
    SetGame{"zaxxon", "Zaxxon"},
};

constexpr std::span<const SetGame> kAll = kPaper;
constexpr std::array kSets = {
    GameSet{"training", "the paper's five training games", kAll.first(kTrainingGames)},
    GameSet{"testing", "the paper's fifty testing games", kAll.subspan(kTrainingGames)},
    GameSet{"paper", "the paper's 55 games", kPaper},
    GameSet{"atari100k", "the 26 games of Atari 100k", kAtari100k},
    GameSet{"atari57", "the 57 games with published scores of people", kAtari57},
};

}  // namespace

std::span<const GameSet> game_sets() { return kSets; }

const GameSet* find_game_set(std::string_view name) {
  const auto found = std::ranges::find(kSets, name, &GameSet::name);
  return found == kSets.end() ? nullptr : &*found;
}

}  // namespace racebeam
