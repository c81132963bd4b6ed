/// @file
/// A session for coroutines: each method returns a boost::asio::awaitable. One coroutine at a time uses an
/// AsyncSession, on the executor that it was made with.
#pragma once

#include <chrono>
#include <cstdlib>
#include <deque>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <boost/asio/this_coro.hpp>

#include "racebeam/client/commands.hpp"
#include "racebeam/client/config.hpp"
#include "racebeam/client/fields.hpp"
#include "racebeam/client/lines.hpp"

namespace RACEBEAM_CLIENT_NAMESPACE {

/// Version of the protocol that this client speaks.
inline constexpr int kProtocol = 1;

/// One session for coroutines of Boost.Asio. It is used by one coroutine at a time, on the executor that it
/// was made with; a second one gets std::logic_error. On several threads, that executor must be a strand.
class AsyncSession : public Commands<AsyncSession> {
 public:
  /// A session over a connection that is open. Use async_connect() or async_launch().
  explicit AsyncSession(std::shared_ptr<detail::Lines> lines) : lines_(std::move(lines)) {}
  AsyncSession(AsyncSession&&) noexcept = default;
  AsyncSession& operator=(AsyncSession&& other) noexcept = default;
  ~AsyncSession() { close(); }

  /// Ends the session. Further calls do nothing. It does not wait for its own server, which a thread
  /// kills if it has not ended after 10 seconds.
  void close() noexcept {
    if (lines_) lines_->close();
    ended_ = true;
  }

  /// Sends any request, and returns its reply. Replies of requests that were sent ahead stay to be received.
  boost::asio::awaitable<Reply> request(std::string_view line) { return ask_for(std::string(line), whole); }

  /// Sends a request without waiting for its reply.
  boost::asio::awaitable<void> send(std::string_view line) { return send_line(std::string(line)); }

  /// Receives the next reply to a request that was sent ahead.
  boost::asio::awaitable<Reply> receive() {
    const Turn turn(busy_);
    if (arrived_.empty()) arrived_.push_back(co_await outcome());
    Outcome next = std::move(arrived_.front());
    arrived_.pop_front();
    co_return take(std::move(next));
  }

 private:
  friend class Commands<AsyncSession>;
  friend class CommandMethods<AsyncSession>;
  friend class Session;

  void await_end() noexcept {
    if (lines_) lines_->await_end();
  }

  using Outcome = std::variant<Reply, Refused>;

  /// Bytes of requests without a reply. A server that cannot send its replies stops reading, so this must fit
  /// in its pipe.
  static constexpr std::size_t kMaxAhead = 1U << 15U;

  class Turn {
   public:
    explicit Turn(bool& busy) : busy_(busy) {
      if (busy) throw std::logic_error("another coroutine waits for this session");
      busy = true;
    }
    ~Turn() { busy_ = false; }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

   private:
    bool& busy_;
  };

  template <class Read>
  auto ask_for(std::string line, Read read) -> boost::asio::awaitable<decltype(read(std::declval<Reply>()))> {
    const Turn turn(busy_);
    co_await put(std::move(line));
    while (unanswered_.size() > 1) arrived_.push_back(co_await outcome());
    co_return read(take(co_await outcome()));
  }

  static Reply whole(Reply reply) { return reply; }

  boost::asio::awaitable<void> send_line(std::string line) {
    const Turn turn(busy_);
    co_await put(std::move(line));
  }

  boost::asio::awaitable<void> put(std::string line) {
    const std::size_t begin = line.find_first_not_of(' ');
    if (line.find('\n') != std::string::npos || (begin != std::string::npos && line[begin] == '#'))
      throw std::invalid_argument("a request is one line, and no comment: '" + line + "'");
    while (ahead_ > 0 && ahead_ + line.size() > kMaxAhead) arrived_.push_back(co_await outcome());
    if (ended_) throw Lost("the session has ended");
    ahead_ += line.size();
    unanswered_.push_back(line);
    line += '\n';
    try {
      co_await lines_->write(line);
    } catch (const TimedOut&) {
      close();
      throw;
    } catch (const Lost&) {  // the server may have said why it ends, before it did: outcome() reads that
    }
  }

  boost::asio::awaitable<Outcome> outcome() {
    if (ended_) throw Lost("the session has ended");
    try {
      std::string line = co_await lines_->read();
      std::string request;  // without one, the server says why it ends
      if (!unanswered_.empty()) {
        request = std::move(unanswered_.front());
        unanswered_.pop_front();
        ahead_ -= request.size();
      }
      std::string bytes;  // read before anything is thrown: the next reply begins behind them
      if (const std::size_t count = take_raw(line)) bytes = co_await lines_->read_bytes(count);
      co_return parse(request, std::move(line), bytes);
    } catch (const Lost&) {
      close();
      throw;
    } catch (const std::invalid_argument& damaged) {
      close();
      throw Lost(std::string("a reply of the server is damaged: ").append(detail::printable(damaged.what())));
    }
  }

  /// How many bytes follow the line, which loses the pair that says so (the encoding raw).
  static std::size_t take_raw(std::string& line) {
    constexpr std::string_view kRaw = " raw=";
    const std::size_t last = line.rfind(' ');
    if (!line.starts_with("ok ") || line.compare(last, kRaw.size(), kRaw) != 0) return 0;
    const auto count = detail::to_number<std::size_t>(std::string_view(line).substr(last + kRaw.size()));
    line.resize(last);
    return count;
  }

  /// Parses the reply to a request. Throws std::invalid_argument if it is damaged.
  Outcome parse(std::string_view request, std::string line, std::string_view bytes) {
    constexpr std::string_view kError = "error ";
    if (line.starts_with(kError)) {
      const std::size_t end = line.find(' ', kError.size());
      return Refused(line.substr(kError.size(), end - kError.size()),
                     end == std::string::npos ? "" : line.substr(end + 1));
    }
    if (line != "ok" && !line.starts_with("ok "))
      throw std::invalid_argument(std::string("'").append(line, 0, 60).append("' is not a reply"));
    return fields_.decode_reply(request, std::move(line), bytes);
  }

  static Reply take(Outcome outcome) {
    if (const Refused* refused = std::get_if<Refused>(&outcome)) throw Refused(*refused);
    return std::get<Reply>(std::move(outcome));
  }

  std::shared_ptr<detail::Lines> lines_;
  detail::Fields fields_;
  std::deque<std::string> unanswered_;
  std::deque<Outcome> arrived_;  // replies that were read to make room for a request
  std::size_t ahead_ = 0;        // bytes of `unanswered_`
  bool ended_ = false;
  bool busy_ = false;
};

namespace detail {

inline std::string environment_variable(const char* name, const char* otherwise) {
  const char* value = std::getenv(name);
  return value != nullptr ? value : otherwise;
}

/// Opens a session. Lost names the place where no server is.
inline asio::awaitable<AsyncSession> open_session_at(std::shared_ptr<Lines> lines, std::string place) {
  try {
    co_await lines->open();
  } catch (const TimedOut&) {
    throw;
  } catch (const Lost& lost) {
    throw Lost("no server answers at " + place + ": " + lost.what());
  }
  co_return AsyncSession(std::move(lines));
}

inline asio::awaitable<AsyncSession> connect_once(std::string text, Options options) {
  const asio::any_io_executor executor = co_await asio::this_coro::executor;
  const Address address = parse_address(text);
  if (options.token.empty()) options.token = address.token;
  const auto lines = std::make_shared<Lines>(make_connection(executor, address, options), executor, options);
  AsyncSession session = co_await open_session_at(lines, address.source.empty() ? text : address.source);
  std::string greeting = "hello";
  if (!options.token.empty()) greeting += " token=" + options.token;
  const Reply hello = co_await session.request(greeting);
  if (!hello.first().has("protocol") || hello.first().text("protocol") != std::to_string(kProtocol))
    throw Lost("'" + printable(hello.line().substr(0, 60)) +
               "' does not say protocol=" + std::to_string(kProtocol));
  co_return session;
}

/// Connects to an address, and tries again while the time of `?wait=SECONDS` lasts.
inline asio::awaitable<AsyncSession> connect_within(std::string text, Options options) {
  const auto [address, seconds] = without_wait(text);
  const std::string name(address);
  asio::steady_timer pause(co_await asio::this_coro::executor);
  const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (true) {
    try {
      auto session = connect_once(name, options);
      co_return co_await std::move(session);
    } catch (const Lost&) {
      if (std::chrono::steady_clock::now() >= until) throw;
    }
    pause.expires_after(std::chrono::milliseconds(50));
    co_await pause.async_wait(asio::use_awaitable);
  }
}

// g++ 12 takes the operator delete of the coroutine's frame for a wrong one.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"
#endif
inline asio::awaitable<AsyncSession> launch_process(std::vector<std::string> command, Options options) {
  const asio::any_io_executor executor = co_await asio::this_coro::executor;
  auto connection = std::make_unique<ProcessConnection>(executor, std::move(command));
  auto lines = std::make_shared<Lines>(std::move(connection), executor, options);
  co_await lines->open();
  co_return AsyncSession(std::move(lines));
}
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC diagnostic pop
#endif

}  // namespace detail

// These are not coroutines themselves, and the defaults are not temporary objects: g++ 12 destroys some
// temporary arguments in co_await twice.

/// Connects to the server at an address, by default that in the environment variable RACEBEAM_ADDRESS:
/// `tcp://HOST:PORT`, `tls://HOST:PORT`, `unix:PATH`, `pipes:PREFIX`, `stdio`, or `file:PATH`, a server's
/// `--ready-file`.
///
/// Throws std::invalid_argument if the address has another form, Lost if no server of this protocol answers,
/// and Refused if the server refuses the session.
inline boost::asio::awaitable<AsyncSession> async_connect(std::string_view address = {},
                                                          const Options& options = Options::usual()) {
  return detail::connect_within(
      address.empty() ? detail::environment_variable("RACEBEAM_ADDRESS", "") : std::string(address), options);
}

/// Starts a server, and opens a session with it. The server stops when the session ends.
/// @param program path of the program; default: that of the environment variable RACEBEAM_PROGRAM, else
/// `racebeam`
/// @param arguments options of `racebeam serve`
/// @param options `token` has no effect
inline boost::asio::awaitable<AsyncSession> async_launch(std::string_view program = {},
                                                         const std::vector<std::string>& arguments = {},
                                                         const Options& options = Options::usual()) {
  std::vector<std::string> command{
      program.empty() ? detail::environment_variable("RACEBEAM_PROGRAM", "racebeam") : std::string(program),
      "serve", "--stdio", "--log-level", "warning"};
  command.insert(command.end(), arguments.begin(), arguments.end());
  return detail::launch_process(std::move(command), options);
}

}  // namespace RACEBEAM_CLIENT_NAMESPACE
