// Runs the test cases of one executable. Status 77: something was left out, and nothing was asserted.
#define CATCH_CONFIG_RUNNER
#include <algorithm>
#include <catch2/catch.hpp>

#if !defined(_WIN32)
#include <sys/resource.h>
#endif

#include "tests/support/skip.hpp"

namespace {

constexpr int kSkipped = 77;
std::size_t asserted = 0;

struct Counter : Catch::TestEventListenerBase {
  using TestEventListenerBase::TestEventListenerBase;
  void testRunEnded(const Catch::TestRunStats& run) override { asserted = run.totals.assertions.total(); }
};
CATCH_REGISTER_LISTENER(Counter)

// A test whose subject ignores its own limit must not fill the disk: the system ends a program that writes
// more than this to a file. One test makes a file of exactly this size, which takes no room.
void limit_files() {
#if !defined(_WIN32)
  constexpr rlim_t kLargestFile = rlim_t{1} << 30;
  rlimit limit{};
  if (::getrlimit(RLIMIT_FSIZE, &limit) != 0) return;
  limit.rlim_cur = std::min(limit.rlim_cur, kLargestFile);
  ::setrlimit(RLIMIT_FSIZE, &limit);
#endif
}

}  // namespace

int main(int count, char* words[]) {
  limit_files();
  const int status = Catch::Session().run(count, words);
  return status == 0 && asserted == 0 && racebeam::test::left_out > 0 ? kSkipped : status;
}
