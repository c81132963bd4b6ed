// Keeps the tasks of a server running: listeners, the monitor of idle sessions, the handler of signals.
#pragma once

#include <chrono>
#include <functional>
#include <string>

#include "server/scheduling/task.hpp"

namespace racebeam {

Task<> pause(boost::asio::io_context& loop, std::chrono::milliseconds time);

// Runs the task that `body` returns, on the thread of the loop, until it ends. After an exception, logs it,
// pauses, and runs the task again; most likely, memory or file descriptors have run out. `what` is the
// subject of the sentence in the log. Throws std::bad_alloc.
void keep_running(boost::asio::io_context& loop, std::string what, std::function<Task<>()> body);

// Calls `step` until it no longer throws std::bad_alloc. It blocks, so the thread must not have other work.
void retry_until_memory(const std::function<void()>& step);

}  // namespace racebeam
