#include "recording/recorder.hpp"

#include <thread>
#include <utility>  // needed by Asio 1.74

#include <boost/asio/post.hpp>
#include <boost/asio/strand.hpp>
#include <boost/asio/thread_pool.hpp>

#include "recording/footage.hpp"

namespace racebeam {
namespace {

namespace net = boost::asio;
using namespace std::chrono_literals;

constexpr std::size_t kThreads = 2;  // so that one file's sync does not hold up all others
constexpr auto kLastMoment = 100ms;  // the time to remove recordings that were aborted

}  // namespace

class Recorder::Threads : public net::thread_pool {
 public:
  Threads() : net::thread_pool(kThreads) {}

  Recording::Post strand() {  // runs jobs in their order
    return
        [strand = net::make_strand(*this)](std::function<void()> job) { net::post(strand, std::move(job)); };
  }
};

Recorder::Recorder(std::string folder, std::size_t most_files)
    : folder_(std::move(folder)),
      claims_(std::make_shared<Claims>(most_files)),
      threads_(std::make_unique<Threads>()) {}

// A thread that hangs in a system call can neither be ended nor joined: it remains until the process ends.
Recorder::~Recorder() {
  if (*given_up_ && !idle()) {
    static_cast<void>(threads_.release());
  } else {
    threads_->join();
  }
}

std::shared_ptr<Recording> Recorder::begin(std::vector<MediaKind> kinds, const std::string& name,
                                           std::size_t most_bytes, const Environment& machine,
                                           const Charge& charge) {
  Order order{std::move(kinds), folder_, name, most_bytes, footage_of(machine)};
  auto claim = std::make_unique<Claim>(claims_, order.file_names());
  if (charge) order.charge = charge(order.memory());
  const auto recording =
      std::make_shared<Recording>(std::move(order), std::move(claim), threads_->strand(), given_up_);
  recording->begin();
  return {recording.get(), [recording](Recording* one) { one->finish(); }};
}

std::shared_ptr<LogWriter> Recorder::begin_log(const std::string& name, SubmissionOrder order,
                                               std::size_t most_bytes) {
  auto claim = std::make_unique<Claim>(claims_, std::vector{name + '/' + order.unit});
  order.path = folder_ + '/' + name;
  const auto writer = std::make_shared<LogWriter>(std::move(order), most_bytes, std::move(claim),
                                                  threads_->strand(), given_up_);
  writer->begin();
  return {writer.get(), [writer](LogWriter* one) { one->finish(); }};
}

bool Recorder::wait(std::chrono::milliseconds patience) const {
  const auto end = std::chrono::steady_clock::now() + patience;
  while (!idle() && std::chrono::steady_clock::now() < end) std::this_thread::sleep_for(1ms);
  return idle();
}

void Recorder::end(std::chrono::milliseconds patience) {
  if (wait(patience)) return;
  *given_up_ = true;
  wait(kLastMoment);
}

bool Recorder::idle() const { return claims_->empty(); }

}  // namespace racebeam
