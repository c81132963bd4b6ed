// A share that memory does not suffice for leaves its name free. Allocations of this program fail on request,
// so that it has no other tests.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <new>

#include "protocol/line/share.hpp"

namespace {

thread_local int allocations_left = -1;  // -1: any number

}  // namespace

void* operator new(std::size_t size) {
  if (allocations_left == 0) throw std::bad_alloc();
  if (allocations_left > 0) --allocations_left;
  if (void* const memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }

using namespace racebeam;

TEST_CASE("A name stays free if the n-th allocation of its share fails") {
  const auto shares = std::make_shared<Shares>();
  const std::string name = "a name that is too long to be stored inside a string";
  int failures = 0;
  for (std::unique_ptr<Sharing> sharing; sharing == nullptr; ++failures) {
    allocations_left = failures;
    try {
      sharing = Sharing::open(shares, name, 8);
      allocations_left = -1;
      REQUIRE(sharing != nullptr);
    } catch (const std::bad_alloc&) {
      allocations_left = -1;
      CHECK(shares->find(name) == nullptr);
    }
  }
  CHECK(failures > 3);
  CHECK(shares->all().empty());
}
