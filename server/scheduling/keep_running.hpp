// Keeps the tasks of a server running: listeners, the monitor of idle sessions, the handler of signals.
#pragma once

#include <chrono>
#include <functional>
#include <string>

#include "server/scheduling/task.hpp"

namespace racebeam {

Task<> pause(boost::asio::io_context& loop, std::chrono::milliseconds time);

// Runs the task that `body` returns, on the thread of the loop, until it ends. After an exception, which most
// likely means that memory or files are out, logs it, pauses, and runs it again. `what` is a subject for the
// log. Both hold until the end. Throws std::bad_alloc.
void keep_running(boost::asio::io_context& loop, std::string what, std::function<Task<>()> body);

// Calls `step` until it no longer throws std::bad_alloc. For threads that have nothing else to do.
void insist(const std::function<void()>& step);

}  // namespace racebeam
