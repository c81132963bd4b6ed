#include "racebeam/game.hpp"

#include <algorithm>
#include <iterator>

#include "library/internals.hpp"
#include "system/similar.hpp"

namespace racebeam::v0 {
namespace {

std::vector<Action> as_actions(const std::vector<int>& numbers) {
  std::vector<Action> actions;
  std::ranges::transform(numbers, std::back_inserter(actions),
                         [](int number) { return static_cast<Action>(number); });
  return actions;
}

}  // namespace

Game::Game(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}

Game Game::recognise(const Image& image) {
  return Internals::wrap(racebeam::recognise(*Internals::of(image)).game);
}

Game Game::named(const std::string& name) {
  if (auto game = find_game(name)) return Internals::wrap(std::move(game));
  const std::string near = did_you_mean(name, game_names());
  throw Error(Error::Cause::kGame,
              "unknown game '" + name + "';" + (near.empty() ? " Game::names() lists all" : near));
}

Game Game::load(const std::string& path) {
  return guarded(Error::Cause::kGame, [&] { return Internals::wrap(load_game_file(path)); });
}

std::vector<std::string> Game::names() {
  const auto names = game_names();
  return {names.begin(), names.end()};
}

const std::string& Game::name() const noexcept { return impl_->game->name; }
const std::string& Game::title() const noexcept { return impl_->game->title; }
bool Game::has_rewards() const noexcept { return impl_->game->has_rule(); }
bool Game::fits(const Image& image) const { return !is_other_dump(*impl_->game, *Internals::of(image)); }
std::vector<Action> Game::legal_actions() const { return as_actions(impl_->game->legal_actions); }
std::vector<Action> Game::minimal_actions() const { return as_actions(impl_->game->minimal_actions); }
std::vector<int> Game::modes() const { return impl_->game->offered_modes(); }
int Game::default_mode() const noexcept { return impl_->game->default_mode; }
std::vector<int> Game::difficulties() const { return impl_->game->difficulties; }

}  // namespace racebeam::v0
