/// @file
/// A session whose methods return when the reply is there. Threads may share it: each request gets its own
/// reply.
#pragma once

#include <atomic>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include <boost/asio/co_spawn.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>

#include "racebeam/client/async_session.hpp"
#include "racebeam/client/config.hpp"

namespace RACEBEAM_CLIENT_NAMESPACE {

/// One session. Threads may share it: each request gets its own reply.
class Session : public Commands<Session> {
 public:
  Session(Session&&) noexcept = default;
  Session& operator=(Session&&) noexcept = default;

  /// Ends the session, and waits for its own server to end: it is killed after 10 seconds. More than
  /// once does nothing. Another thread that waits for a reply gets Lost.
  void close() {
    boost::asio::post(state_->loop, [state = state_.get()] { state->session->close(); });
    const std::lock_guard lock(state_->mutex);  // a thread that waits for a reply has it, or has lost it
    state_->run();
    state_->session->await_end();
  }

  /// Sends any request, and returns its reply. Replies of requests that were sent ahead stay to be received.
  Reply request(std::string_view line) { return state_->wait(state_->session->request(line)); }
  /// Sends a request without waiting for its reply.
  void send(std::string_view line) { state_->wait(state_->session->send(line)); }
  /// The next reply to a request that was sent ahead.
  Reply receive() { return state_->wait(state_->session->receive()); }

 private:
  friend class Commands<Session>;
  friend class CommandMethods<Session>;
  friend Session connect(std::string_view address, const Options& options);
  friend Session launch(std::string_view program, const std::vector<std::string>& arguments,
                        const Options& options);

  struct State {
    boost::asio::io_context loop{1};
    std::mutex mutex;
    std::optional<AsyncSession> session;

    State() = default;
    ~State() {
      if (!session) return;
      session->close();
      session->await_end();
    }
    State(const State&) = delete;
    State& operator=(const State&) = delete;

    void run() {
      loop.restart();
      loop.run();
    }

    /// The result of a coroutine.
    template <class Result>
    Result wait(boost::asio::awaitable<Result> work) {
      const std::lock_guard lock(mutex);
      std::exception_ptr failure;
      if constexpr (std::is_void_v<Result>) {
        boost::asio::co_spawn(loop, std::move(work),
                              [&](const std::exception_ptr& thrown) { failure = thrown; });
        run();
        if (failure) std::rethrow_exception(failure);
      } else {
        std::optional<Result> result;
        boost::asio::co_spawn(loop, std::move(work), [&](const std::exception_ptr& thrown, Result value) {
          failure = thrown;
          result.emplace(std::move(value));
        });
        run();
        if (failure) std::rethrow_exception(failure);
        return std::move(*result);
      }
    }

    /// Keeps the session that a coroutine makes.
    static boost::asio::awaitable<void> keep(std::optional<AsyncSession>& session,
                                             boost::asio::awaitable<AsyncSession> work) {
      session.emplace(co_await std::move(work));
    }
  };

  explicit Session(boost::asio::awaitable<AsyncSession> work) : state_(std::make_unique<State>()) {
    state_->wait(State::keep(state_->session, std::move(work)));
  }

  template <class Read>
  auto ask_for(std::string_view line, Read read) {
    return read(request(line));
  }

  std::unique_ptr<State> state_;
};

/// Connects to the server at an address, as async_connect() does.
inline Session connect(std::string_view address = {}, const Options& options = Options::usual()) {
  return Session(async_connect(address, options));
}

/// Starts its own server, as async_launch() does.
inline Session launch(std::string_view program = {}, const std::vector<std::string>& arguments = {},
                      const Options& options = Options::usual()) {
  return Session(async_launch(program, arguments, options));
}

}  // namespace RACEBEAM_CLIENT_NAMESPACE
