// What the searches keep from one decision to the next, beside their trees.
#include <catch2/catch.hpp>

#include "agents/planning/rollout_search.hpp"
#include "agents/planning/search_tree.hpp"
#include "agents/planning/uct.hpp"
#include "tests/agents/planning/toy_model.hpp"

using namespace racebeam;
using namespace racebeam::test;

namespace {

constexpr int kActions = 4;

// All actions are as good, so that the generator chooses. At 0 they give 5, and elsewhere 10.
Arrow rewarding(int place, int) { return {place, place == 0 ? 5.0 : 10.0}; }

double value_of(const TreeSearch& search) { return search.value(0); }
double value_of(const RolloutSearch& search) { return search.value(0); }
double value_of(const Uct& search) { return search.root()->children.front()->mean; }

// What a search chooses, and how it values an action, in 20 decisions elsewhere.
template <class Search>
std::vector<double> decisions(Search& search) {
  std::vector<double> found;
  for (int decision = 0; decision < 20; ++decision) {
    search.forget();
    found.push_back(search.choose(ToyModel::place(1)));
    found.push_back(value_of(search));
  }
  return found;
}

template <class Search, class Settings>
void check_that_it_goes_on(const Settings& settings) {
  ToyModel model(kActions, rewarding);
  Search search(model, settings, 1), other(model, settings, 2);
  search.choose(ToyModel::place(0));
  StateWriter out;
  search.write(out);
  StateReader in(out.bytes());
  other.read(in);
  CHECK(in.at_end());
  const std::vector<double> found = decisions(search);
  CHECK(found[1] == 2);  // twice the first reward
  CHECK(decisions(other) == found);
}

}  // namespace

TEST_CASE("A search that is read from a checkpoint decides and values as the one that wrote it") {
  check_that_it_goes_on<TreeSearch>(TreeSettings{.frames = 20});
  check_that_it_goes_on<RolloutSearch>(RolloutSettings{});
  check_that_it_goes_on<Uct>(UctSettings{.simulations = 5, .depth = 1});
}
