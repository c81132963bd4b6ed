#include "system/forks.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>

namespace {

int forks = 0;

}  // namespace

TEST_CASE("a function is called in the copies of the process only") {
  racebeam::call_in_forked_children([] { ++forks; });
  const pid_t child = ::fork();
  if (child == 0) ::_exit(forks);
  int status = 0;
  REQUIRE(::waitpid(child, &status, 0) == child);
  CHECK(WEXITSTATUS(status) == 1);
  CHECK(forks == 0);
}
