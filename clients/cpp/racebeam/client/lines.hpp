#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "racebeam/client/connection.hpp"
#include "racebeam/client/errors.hpp"

namespace racebeam::client::detail {

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
    } catch (const boost::system::system_error& failure) {
      lose(failure);
    }
  }

  asio::awaitable<void> write(std::string_view line) {
    const Watch watch(*this);
    try {
      co_await connection_->write(asio::buffer(line));
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

 private:
  /// Closes the connection if the time is over before it is destroyed.
  class Watch {
   public:
    explicit Watch(Lines& lines) : timer_(lines.timer_) {
      if (!lines.options_.timeout) return;
      timer_.expires_after(*lines.options_.timeout);
      timer_.async_wait([weak = lines.weak_from_this()](boost::system::error_code stopped) {
        const auto self = stopped ? nullptr : weak.lock();
        if (!self) return;
        self->late_ = true;
        self->close();
      });
    }
    ~Watch() { timer_.cancel(); }
    Watch(const Watch&) = delete;
    Watch& operator=(const Watch&) = delete;

   private:
    asio::steady_timer& timer_;
  };

  [[noreturn]] void lose(const boost::system::system_error& failure) {
    if (late_)
      throw TimedOut("the server did not answer in " + std::to_string(options_.timeout->count()) +
                     " milliseconds");
    if (failure.code() == asio::error::eof) throw Lost("the server has closed the connection");
    throw Lost(std::string("the connection failed: ").append(failure.what()));
  }

  asio::awaitable<void> read_more() {
    make_room();
    try {
      filled_ += co_await connection_->read(asio::buffer(data_.data() + filled_, data_.size() - filled_));
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
  bool late_ = false;
  std::vector<char> data_;
  std::size_t begin_ = 0, filled_ = 0;
};

}  // namespace racebeam::client::detail
