// A pool of threads, each with an event loop of its own. A session stays on one of them, so that nothing is
// locked and nobody is woken up between two of its lines; one loop for all threads cost four futex calls a
// line.
#pragma once

#include <atomic>
#include <list>
#include <utility>  // Asio 1.74 forgets it

#include <boost/asio/io_context.hpp>

namespace racebeam {

struct Loop {
  boost::asio::io_context context{1};
  std::atomic<int> sessions = 0;
};

class Loops {
 public:
  explicit Loops(unsigned threads);

  Loop& first() { return loops_.front(); }
  Loop& idlest();  // with the fewest sessions
  void run();      // until stop() is called
  void stop();

 private:
  std::list<Loop> loops_;
};

}  // namespace racebeam
