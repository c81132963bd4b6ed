#include "system/child_program.hpp"

#include <signal.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <system_error>
#include <thread>

using namespace racebeam;
using namespace std::chrono_literals;

namespace {

constexpr auto kShell = "sh";

void wait_for(ChildProgram& program) {
  while (!program.has_ended()) std::this_thread::sleep_for(1ms);
}

// What the program says until it has ended.
std::string said_by(const std::string& script) {
  ChildProgram program({kShell, "-c", script});
  program.close_input();
  wait_for(program);
  return program.errors();
}

}  // namespace

TEST_CASE("A program reads what is sent, until its input is closed") {
  ChildProgram program({kShell, "-c", "cat >&2"});
  CHECK(program.send("some text") == 9);
  CHECK_FALSE(program.has_ended());
  CHECK_FALSE(program.has_succeeded());
  CHECK(program.has_input());
  program.close_input();
  CHECK_FALSE(program.has_input());
  wait_for(program);
  CHECK(program.has_ended());
  CHECK(program.has_succeeded());
  CHECK(program.errors() == "some text");
  CHECK(program.errors().empty());
}

TEST_CASE("Only a program that ends with status 0 has succeeded") {
  for (const char* const script : {"exit 3", "kill -KILL $$"}) {
    ChildProgram program({kShell, "-c", script});
    wait_for(program);
    INFO(script);
    CHECK_FALSE(program.has_succeeded());
  }
}

TEST_CASE(
    "A program that does not read is sent as much as there is room for, and one that has ended nothing") {
  const std::string much(1 << 16, 'x');
  ChildProgram waits({kShell, "-c", "exec sleep 100"});
  std::ptrdiff_t sent = 0;
  for (int i = 0; i < 1000 && (sent = waits.send(much)) > 0; ++i) {
  }
  CHECK(sent == 0);
  ChildProgram ended({"true"});
  wait_for(ended);
  CHECK(ended.send("x") == -1);
}

TEST_CASE("What a program writes to standard output is lost") {
  CHECK(said_by("echo lost; echo kept >&2") == "kept\n");
}

TEST_CASE("A program has no signal blocked") {
  sigset_t all, before;
  sigfillset(&all);
  ::pthread_sigmask(SIG_BLOCK, &all, &before);
  ChildProgram program({kShell, "-c", "kill -TERM $$; echo ignored >&2"});
  wait_for(program);
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  CHECK(program.errors().empty());
}

TEST_CASE("A program that the PATH does not have is an error") {
  try {
    ChildProgram({"no-such-program"});
    FAIL("it cannot run");
  } catch (const std::system_error& error) {
    CHECK(error.code() == std::errc::no_such_file_or_directory);
    CHECK_THAT(error.what(), Catch::StartsWith("cannot run no-such-program"));
  }
}
