// What a vector environment does where machines fail.
#include "environment/vector/vector_environment.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <stdexcept>
#include <string>

#include "tests/environment/steered.hpp"

namespace racebeam {
namespace {

// Counts how many of them there are.
class Counted : public std::runtime_error {
 public:
  explicit Counted(std::size_t number) : std::runtime_error("machine " + std::to_string(number) + " fails") {
    most = std::max(most, ++alive);
  }
  Counted(const Counted& other) : std::runtime_error(other) { most = std::max(most, ++alive); }
  ~Counted() override { --alive; }

  static inline int alive = 0, most = 0;
};

// Runs machines from the last to the first. Those from `first_bad` on fail when they are shown.
struct Backwards final : VectorHost {
  void run_all(std::size_t count, const std::function<void(std::size_t)>& task) override {
    while (count > 0) task(--count);
  }
  void opened(std::size_t, Slot&) override {}
  void ended(std::size_t, const Slot&) override {}
  void show(std::size_t number, const Slot&) override {
    ++shows;
    if (number >= first_bad) throw Counted(number);
  }
  std::size_t first_bad = 1000;
  int shows = 0;
};

TEST_CASE("Of many machines that fail, the first one's failure is thrown, and no other is kept") {
  const std::vector<Cartridge> cartridges(9, {test::counter_image(), test::game()});
  Backwards host;
  VectorEnvironment vector(cartridges, SlotSettings(), Autoreset::kNextStep, host);
  const std::vector<Act> acts(9);
  host.first_bad = 3;
  CHECK_THROWS_WITH(vector.step(acts), "machine 3 fails");
  CHECK_THROWS_WITH(vector.reset(), "machine 3 fails");
  CHECK_THROWS_WITH(VectorEnvironment(cartridges, SlotSettings(), Autoreset::kNextStep, host),
                    "machine 3 fails");
  CHECK(Counted::most <= 2);  // the one that is kept, and the one that comes
  CHECK(Counted::alive == 0);
  host.first_bad = 1000;
  CHECK_NOTHROW(vector.step(acts));
}

TEST_CASE("Machines after one that fails are not made") {
  struct Forwards final : VectorHost {
    void run_all(std::size_t count, const std::function<void(std::size_t)>& task) override {
      for (std::size_t number = 0; number < count; ++number) task(number);
    }
    void opened(std::size_t number, Slot&) override {
      ++made;
      if (number == 2) throw std::bad_alloc();
    }
    void ended(std::size_t, const Slot&) override {}
    void show(std::size_t, const Slot&) override {}
    int made = 0;
  } host;
  const std::vector<Cartridge> cartridges(9, {test::counter_image(), test::game()});
  CHECK_THROWS_AS(VectorEnvironment(cartridges, SlotSettings(), Autoreset::kNextStep, host), std::bad_alloc);
  CHECK(host.made == 3);
}

}  // namespace
}  // namespace racebeam
