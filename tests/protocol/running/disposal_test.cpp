#include "protocol/running/disposal.hpp"

#include <atomic>
#include <catch2/catch.hpp>
#include <future>

using namespace racebeam;

namespace {

constexpr std::size_t kLarge = Disposal::kWorthwhile;

// Tells the thread on which it was destroyed, after `may_go`.
struct Probe {
  Probe(std::promise<std::thread::id>& promise, std::shared_future<void> go)
      : destroyed(&promise), may_go(std::move(go)) {}
  ~Probe() {
    may_go.wait();
    destroyed->set_value(std::this_thread::get_id());
  }
  std::promise<std::thread::id>* destroyed;
  std::shared_future<void> may_go;
};

}  // namespace

TEST_CASE("A large object is destroyed elsewhere, and counts until then") {
  const auto disposal = std::make_shared<Disposal>();
  const auto memory = std::make_shared<MemoryBudget>();
  std::promise<std::thread::id> destroyed;
  std::promise<void> go;
  dispose(disposal, memory, kLarge, std::make_unique<Probe>(destroyed, go.get_future().share()));
  CHECK(memory->taken() == kLarge);
  go.set_value();
  CHECK(destroyed.get_future().get() != std::this_thread::get_id());
  while (memory->taken() != 0) std::this_thread::yield();
}

TEST_CASE("A small object is destroyed at once, as are all without a disposal") {
  const auto memory = std::make_shared<MemoryBudget>();
  std::promise<void> go;
  go.set_value();
  const std::shared_future<void> may_go = go.get_future().share();
  for (const bool small : {false, true}) {
    std::promise<std::thread::id> destroyed;
    dispose(small ? std::make_shared<Disposal>() : nullptr, memory, small ? kLarge - 1 : kLarge,
            std::make_unique<Probe>(destroyed, may_go));
    CHECK(destroyed.get_future().get() == std::this_thread::get_id());
    CHECK(memory->taken() == 0);
  }
}

TEST_CASE("What is left is destroyed with the disposal") {
  std::atomic<int> destroyed = 0;
  struct Counter {
    explicit Counter(std::atomic<int>* counted) : count(counted) {}
    ~Counter() { ++*count; }
    std::atomic<int>* count;
  };
  {
    Disposal disposal;
    for (int i = 0; i < 100; ++i) disposal.take(std::make_shared<Counter>(&destroyed));
  }
  CHECK(destroyed == 100);
}

TEST_CASE("The pages of a long text can be released before it is destroyed") {
  std::string text(std::size_t{16} << 20, 'x'), shorter = "short";
  release_pages(text);
  release_pages(shorter);
  CHECK(text[text.size() / 2] == '\0');
  CHECK(shorter == "short");
}
