// A pool of threads, each with its own event loop. A session stays on one loop, so no lock is taken and no
// thread is woken between two of its lines. With one loop for all threads, a line cost four futex calls.
#pragma once

#include <atomic>
#include <exception>
#include <list>
#include <thread>
#include <unordered_set>
#include <utility>  // Asio 1.74 needs it
#include <vector>

#include <boost/asio/io_context.hpp>

#include "server/operation/metrics.hpp"
#include "server/scheduling/turns.hpp"
#include "system/busy_poll.hpp"
#include "system/program/gate.hpp"

namespace racebeam {

class Client;

struct Loop {
  Loop(Meter& counting, std::chrono::microseconds busy_poll);

  void run();            // runs until its context is stopped
  void handle_events();  // handles what is ready, for a few milliseconds at most

  Gate started;  // opens once its thread knows whether it can run
  std::atomic<int> sessions = 0;
  Meter& meter;
  BusyPoll busy;                        // only touched on the loop's thread
  Turns turns;                          // the same
  std::unordered_set<Client*> clients;  // clients in a session; only touched on the loop's thread
  boost::asio::io_context context{1};   // the last member, so that what waits in it is destroyed first

 private:
  void handle_next();  // handles the next turn or event
};

class Loops {
 public:
  Loops(unsigned threads, std::chrono::microseconds busy_poll, Metrics& metrics);
  ~Loops();
  Loops(const Loops&) = delete;
  Loops& operator=(const Loops&) = delete;

  // Starts a thread for each loop, which waits for run(). Throws std::system_error if the system gives fewer
  // threads, and std::bad_alloc if a thread gets no memory.
  void start();
  Loop& first() { return loops_.front(); }
  Loop& least_loaded();  // the loop with the fewest sessions
  std::list<Loop>& all() { return loops_; }
  int sessions() const;
  void run();  // until stop() is called
  void stop();

 private:
  void work(Loop& loop);  // the body of the loop's thread

  std::list<Loop> loops_;
  std::exception_ptr failure_;  // of a thread that cannot run; read after it has started
  Gate running_;
  std::vector<std::jthread> threads_;
};

}  // namespace racebeam
