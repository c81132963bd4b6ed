// How sessions of the client in C++ end: close(), time limits, and servers of their own.
#include <sys/stat.h>

#include <boost/asio/detached.hpp>
#include <catch2/catch.hpp>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <racebeam/client.hpp>
#include <thread>

namespace {

namespace asio = boost::asio;
namespace client = racebeam::client;
using asio::ip::tcp;
using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

void run(asio::awaitable<void> work) {
  asio::io_context loop;
  std::exception_ptr failure;
  asio::co_spawn(loop, std::move(work), [&](const std::exception_ptr& thrown) { failure = thrown; });
  loop.run();
  if (failure) std::rethrow_exception(failure);
}

// A connection on which each read and write takes some time.
class SlowConnection final : public client::detail::Connection {
 public:
  SlowConnection(asio::io_context& loop, std::chrono::milliseconds time, bool& open)
      : timer_(loop), time_(time), open_(open) {}
  asio::awaitable<void> open() override { co_return; }
  asio::awaitable<std::size_t> read(asio::mutable_buffer into) override {
    co_await pass();
    co_return asio::buffer_copy(into, asio::buffer("ok\n", 3));
  }
  asio::awaitable<void> write(asio::const_buffer) override { co_await pass(); }
  void close() noexcept override { open_ = false; }

 private:
  asio::awaitable<void> pass() {
    timer_.expires_after(time_);
    co_await timer_.async_wait(asio::use_awaitable);
  }

  asio::steady_timer timer_;
  const std::chrono::milliseconds time_;
  bool& open_;
};

// What a read on a connection that takes `time` gives, if both that and the limit of 20 ms have passed when
// the loop looks. `open` says whether the connection is open afterwards.
std::string read_late(std::chrono::milliseconds time, bool& open) {
  open = true;
  asio::io_context loop;
  client::Options options;
  options.timeout = 20ms;
  auto lines = std::make_shared<client::detail::Lines>(std::make_unique<SlowConnection>(loop, time, open),
                                                       loop.get_executor(), options);
  std::string line;
  asio::co_spawn(loop, lines->read(), [&](const std::exception_ptr& failure, std::string got) {
    try {
      if (failure) std::rethrow_exception(failure);
      line = std::move(got);
    } catch (const client::TimedOut&) {
      line = "timed out";
    }
  });
  loop.poll();
  std::this_thread::sleep_for(60ms);  // the subject: both times pass while nobody looks
  loop.run();
  const bool is_open = open;
  lines.reset();  // which closes it
  open = is_open;
  return line;
}

// A program that goes on after the end of its input.
class Stubborn {
 public:
  Stubborn() {
    std::ofstream(path_) << "#!/bin/sh\nread -r line\necho ok server=test protocol=1\nsleep 5\n";
    ::chmod(path_.c_str(), 0755);
  }
  ~Stubborn() { std::filesystem::remove(path_); }
  Stubborn(const Stubborn&) = delete;
  Stubborn& operator=(const Stubborn&) = delete;

  const std::string& path() const { return path_; }

 private:
  const std::string path_ =
      std::filesystem::temp_directory_path() / ("racebeam-stubborn-" + std::to_string(::getpid()));
};

}  // namespace

TEST_CASE("A reply and the end of its time at once: the earlier one counts, and the session agrees") {
  bool open = false;
  CHECK(read_late(10ms, open) == "ok");
  CHECK(open);
  CHECK(read_late(30ms, open) == "timed out");
  CHECK_FALSE(open);
}

TEST_CASE("Closing ends the session, whatever another thread is at") {
  asio::io_context loop;
  tcp::acceptor acceptor(loop, tcp::endpoint(asio::ip::address_v4::loopback(), 0));
  const std::string address = "tcp://127.0.0.1:" + std::to_string(acceptor.local_endpoint().port());
  std::atomic<int> ended = 0;
  constexpr int kSessions = 400;
  std::jthread server([&] {
    for (int session = 0; session < kSessions; ++session) {
      tcp::iostream stream(acceptor.accept());
      stream.rdbuf()->set_option(tcp::no_delay(true));
      for (std::string line; std::getline(stream, line);) stream << "ok protocol=1\n" << std::flush;
      ++ended;
    }
  });
  std::vector<client::Session> all;
  for (int session = 1; session <= kSessions; ++session) {
    client::Session& game = all.emplace_back(client::connect(address));
    std::atomic<bool> has_begun = false;
    std::jthread other([&] {
      has_begun = true;
      try {
        game.request("act");
      } catch (const client::Lost&) {
      }
    });
    while (!has_begun) std::this_thread::yield();
    for (const auto until = Clock::now() + std::chrono::microseconds(session % 100); Clock::now() < until;)
      continue;
    game.close();
    const auto until = Clock::now() + 5s;
    while (ended < session && Clock::now() < until) std::this_thread::sleep_for(100us);
    REQUIRE(ended == session);
  }
}

TEST_CASE("A coroutine's session does not wait for its own server to end") {
  const Stubborn program;
  run([](std::string path) -> asio::awaitable<void> {
    auto game = co_await client::async_launch(path);
    co_await game.request("hello");
    const auto start = Clock::now();
    game.close();
    CHECK(Clock::now() - start < 1s);
  }(program.path()));
}

TEST_CASE("A session waits for its own server to end") {
  const Stubborn program;
  auto game = client::launch(program.path());
  game.request("hello");
  const auto start = Clock::now();
  game.close();
  CHECK(Clock::now() - start > 1s);
  CHECK(Clock::now() - start < 9s);
}
