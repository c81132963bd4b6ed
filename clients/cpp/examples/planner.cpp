// Looks ahead before each act: plays each action for a while from the present state, and takes the best.
// Usage: planner ACTS. The server's address is in RACEBEAM_ADDRESS.

#include <cstdint>
#include <iostream>
#include <racebeam/client.hpp>
#include <string>
#include <vector>

int main(int count, char** words) {
  constexpr int kAhead = 20;  // acts
  auto game = racebeam::client::connect();
  game.load("beamfall", "seed=1", "frame_skip=4", "sticky=0");
  game.observe("reward", "terminated", "truncated");
  std::vector<std::string> names;
  std::vector<std::vector<std::string>> lists;
  for (const auto& [number, name] : game.actions()) {
    names.push_back(name);
    lists.push_back({name + "*" + std::to_string(kAhead)});
  }
  std::int64_t score = 0;
  bool over = false;
  for (int act = 0; act < (count > 1 ? std::stoi(words[1]) : 100) && !over; ++act) {
    game.save("now");
    const auto branches = game.branch("now", lists);
    std::size_t best = 0;
    for (std::size_t each = 1; each < branches.size(); ++each)
      if (branches[each].group.reward() > branches[best].group.reward()) best = each;
    const auto result = game.act(names[best]);
    score += result.reward();
    over = result.over();
  }
  std::cout << "score " << score << '\n';
}
