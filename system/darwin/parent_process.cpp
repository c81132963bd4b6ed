#include "system/program/parent_process.hpp"

#include <signal.h>
#include <sys/event.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstddef>
#include <cstdint>

namespace racebeam {
namespace {

// Waits until one of the two processes ends. For a process that has ended already, the event is an error.
[[noreturn]] void guard(pid_t parent, pid_t child) {
  for (int file = 0; file < ::getdtablesize(); ++file) ::close(file);
  const int queue = ::kqueue();
  std::array<struct kevent, 2> events{};
  const std::array processes = {parent, child};
  for (std::size_t i = 0; i < events.size(); ++i)
    EV_SET(&events[i], static_cast<std::uintptr_t>(processes[i]), EVFILT_PROC, EV_ADD, NOTE_EXIT, 0, nullptr);
  const int count = ::kevent(queue, events.data(), events.size(), events.data(), events.size(), nullptr);
  bool parent_ended = false, child_ended = false;
  for (int i = 0; i < count; ++i) {
    const auto process = static_cast<pid_t>(events.at(static_cast<std::size_t>(i)).ident);
    parent_ended |= process == parent;
    child_ended |= process == child;
  }
  if (parent_ended && !child_ended) ::kill(child, SIGTERM);
  ::_exit(0);
}

}  // namespace

// macOS cannot send a signal when a parent ends, so a separate process watches the parent. An intermediate
// process starts the watcher and ends at once, so the watcher does not become a child of the program that
// this process executes.
bool end_with_parent(int parent) {
  const pid_t child = ::getpid();
  const pid_t between = ::fork();
  if (between == 0) {
    const pid_t last = ::fork();
    if (last == 0) guard(parent, child);
    ::_exit(last < 0 ? 1 : 0);
  }
  int status = 0;
  const bool is_guarded = between > 0 && ::waitpid(between, &status, 0) == between && status == 0;
  return is_guarded && ::getppid() == parent;
}

}  // namespace racebeam
