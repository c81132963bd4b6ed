/// @file
/// The lines of a session, with its time limits. One coroutine at a time uses a Lines.
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "racebeam/client/config.hpp"
#include "racebeam/client/connection.hpp"
#include "racebeam/client/errors.hpp"

namespace RACEBEAM_CLIENT_NAMESPACE::detail {

/// Lines to and from a server. What fails throws Lost, or TimedOut if the time of the options was over.
class Lines : public std::enable_shared_from_this<Lines> {
 public:
  Lines(std::unique_ptr<Connection> connection, const asio::any_io_executor& executor, const Options& options)
      : connection_(std::move(connection)), options_(options), timer_(executor), data_(1U << 16U) {}
  ~Lines() { close(); }
  Lines(const Lines&) = delete;
  Lines& operator=(const Lines&) = delete;

  asio::awaitable<void> open() {
    const Watch watch(*this);
    try {
      co_await connection_->open();
      check_in_time();
    } catch (const boost::system::system_error& failure) {
      lose(failure);
    }
  }

  asio::awaitable<void> write(std::string_view line) {
    const Watch watch(*this);
    try {
      co_await connection_->write(asio::buffer(line));
      check_in_time();
    } catch (const boost::system::system_error& failure) {
      lose(failure);
    }
  }

  /// The next line, without its end.
  asio::awaitable<std::string> read() {
    const Watch watch(*this);
    std::size_t searched = begin_;
    while (true) {
      const std::string_view arrived(data_.data() + searched, filled_ - searched);
      if (const std::size_t end = arrived.find('\n'); end != std::string_view::npos) {
        std::string line(std::as_const(data_).data() + begin_, arrived.data() + end);
        begin_ += line.size() + 1;
        co_return line;
      }
      const std::size_t behind = filled_ - begin_;
      co_await read_more();
      searched = begin_ + behind;
    }
  }

  /// The next bytes, which follow a line.
  asio::awaitable<std::string> read_bytes(std::size_t count) {
    const Watch watch(*this);
    if (count > options_.longest_reply) refuse_length();
    while (filled_ - begin_ < count) co_await read_more();
    std::string bytes(std::as_const(data_).data() + begin_, count);
    begin_ += count;
    co_return bytes;
  }

  void close() noexcept { connection_->close(); }
  void await_end() noexcept { connection_->await_end(); }

 private:
  /// Closes the connection if the time is over before it is destroyed.
  class Watch {
   public:
    explicit Watch(Lines& lines) : lines_(lines) {
      if (!lines.options_.timeout) return;
      lines.timer_.expires_after(*lines.options_.timeout);
      lines.timer_.async_wait([weak = lines.weak_from_this(), number = lines.watch_](auto stopped) {
        const auto self = stopped ? nullptr : weak.lock();
        if (!self || self->watch_ != number) return;
        self->late_ = true;
        self->close();
      });
    }
    ~Watch() {
      ++lines_.watch_;  // what the timer has posted already cannot be cancelled
      lines_.timer_.cancel();
    }
    Watch(const Watch&) = delete;
    Watch& operator=(const Watch&) = delete;

   private:
    Lines& lines_;
  };

  [[noreturn]] void lose(const boost::system::system_error& failure) {
    check_in_time();
    if (failure.code() == asio::error::eof) throw Lost("the server has closed the connection");
    throw Lost(std::string("the connection failed: ").append(failure.what()));
  }

  /// What arrives together with the end of the time is late, too: the connection is closed.
  void check_in_time() const {
    if (late_)
      throw TimedOut("the server did not answer in " + std::to_string(options_.timeout->count()) +
                     " milliseconds");
  }

  asio::awaitable<void> read_more() {
    make_room();
    try {
      filled_ += co_await connection_->read(asio::buffer(data_.data() + filled_, data_.size() - filled_));
      check_in_time();
    } catch (const boost::system::system_error& failure) {
      lose(failure);
    }
  }

  [[noreturn]] void refuse_length() const {
    throw Lost("the reply of the server is longer than " + std::to_string(options_.longest_reply) + " bytes");
  }

  /// Makes room behind what was read.
  void make_room() {
    if (filled_ - begin_ > options_.longest_reply) refuse_length();
    std::copy(data_.begin() + static_cast<std::ptrdiff_t>(begin_),
              data_.begin() + static_cast<std::ptrdiff_t>(filled_), data_.begin());
    filled_ -= begin_;
    begin_ = 0;
    if (filled_ == data_.size()) data_.resize(2 * data_.size());
  }

  std::unique_ptr<Connection> connection_;
  Options options_;
  asio::steady_timer timer_;
  std::size_t watch_ = 0;  // number of the Watch that is there, or comes next
  bool late_ = false;
  std::vector<char> data_;
  std::size_t begin_ = 0, filled_ = 0;
};

}  // namespace RACEBEAM_CLIENT_NAMESPACE::detail
