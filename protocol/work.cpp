#include "protocol/work.hpp"

#include "protocol/session.hpp"

namespace racebeam {

const Action& ActionQueue::take() {
  const Action& action = actions[next];
  if (++repeated >= action.times) {
    repeated = 0;
    ++next;
  }
  return action;
}

std::int64_t ActionQueue::acts() const {
  std::int64_t sum = 0;
  for (const Action& action : actions) sum += action.times;
  return sum;
}

bool ActWork::go_on(Session& session, int& frames) {
  Player& player = *session.player;
  while (!queue.empty()) {
    if (frames <= 0) return false;
    const int before = player.outcome().frames;
    player.act(queue.take());
    frames -= player.outcome().frames - before;
    if (player.machine().game_over()) break;
  }
  session.count(player.outcome());
  session.out += "ok";
  player.append_view(session.out);
  return true;
}

}  // namespace racebeam
