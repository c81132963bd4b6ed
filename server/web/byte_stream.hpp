// A connection, plain or over TLS, as one type. Code that uses it is compiled once; Asio would instantiate it
// for each type of stream, handler and buffers.
#pragma once

#include <array>
#include <memory>
#include <utility>  // needed by Asio 1.74

#include <boost/asio/any_io_executor.hpp>
#include <boost/asio/associated_executor.hpp>
#include <boost/asio/async_result.hpp>
#include <boost/asio/buffer.hpp>
#include <boost/asio/generic/stream_protocol.hpp>
#include <boost/asio/ssl/stream.hpp>

namespace racebeam {

// Holds a handler of any type, which is called once with an error and a number of bytes.
class IoHandler {
 public:
  using executor_type = boost::asio::any_io_executor;

  template <typename Handler>
  IoHandler(Handler handler, const executor_type& fallback)
      : executor_(boost::asio::get_associated_executor(handler, fallback)),
        call_(std::make_unique<CallOf<Handler>>(std::move(handler))) {}

  executor_type get_executor() const { return executor_; }

  // Gives the memory back before the handler goes on, as Asio demands.
  void operator()(boost::system::error_code error, std::size_t bytes) {
    std::exchange(call_, nullptr).release()->run(error, bytes);
  }

 private:
  struct Call {
    virtual ~Call() = default;
    virtual void run(boost::system::error_code error, std::size_t bytes) = 0;  // deletes this
  };
  template <typename Handler>
  struct CallOf final : Call {
    explicit CallOf(Handler&& which) : handler(std::move(which)) {}
    void run(boost::system::error_code error, std::size_t bytes) override {
      Handler moved = std::move(handler);
      delete this;
      std::move(moved)(error, bytes);
    }
    Handler handler;
  };

  executor_type executor_;
  std::unique_ptr<Call> call_;
};

// Does not own the connection.
class ByteStream {
 public:
  using Socket = boost::asio::generic::stream_protocol::socket;
  using TlsStream = boost::asio::ssl::stream<Socket&>;
  using executor_type = Socket::executor_type;

  explicit ByteStream(Socket& socket) : socket_(&socket) {}
  explicit ByteStream(TlsStream& tls) : socket_(&tls.next_layer()), tls_(&tls) {}

  executor_type get_executor() { return socket_->get_executor(); }

  // Both do what the stream beneath does.
  template <typename Buffers, typename Token>
  auto async_read_some(const Buffers& buffers, Token&& token) {
    return boost::asio::async_initiate<Token, Signature>(
        [this](auto&& done, const Buffers& space) {
          start_read(first<Space>(space), IoHandler(std::forward<decltype(done)>(done), get_executor()));
        },
        token, buffers);
  }
  template <typename Buffers, typename Token>
  auto async_write_some(const Buffers& buffers, Token&& token) {
    return boost::asio::async_initiate<Token, Signature>(
        [this](auto&& done, const Buffers& bytes) {
          start_write(first<Bytes>(bytes), IoHandler(std::forward<decltype(done)>(done), get_executor()));
        },
        token, buffers);
  }

 private:
  using Signature = void(boost::system::error_code, std::size_t);
  // The operations may transfer less than they are asked to, so that a few buffers are enough.
  static constexpr std::size_t kMaxBuffers = 8;
  using Space = std::array<boost::asio::mutable_buffer, kMaxBuffers>;
  using Bytes = std::array<boost::asio::const_buffer, kMaxBuffers>;

  // The first buffers that are not empty.
  template <typename Few, typename Buffers>
  static Few first(const Buffers& buffers) {
    Few few;
    auto next = few.begin();
    const auto end = boost::asio::buffer_sequence_end(buffers);
    for (auto at = boost::asio::buffer_sequence_begin(buffers); at != end && next != few.end(); ++at) {
      const typename Few::value_type buffer = *at;
      if (buffer.size() != 0) *next++ = buffer;
    }
    return few;
  }

  void start_read(const Space& space, IoHandler done);
  void start_write(const Bytes& bytes, IoHandler done);

  Socket* socket_;
  TlsStream* tls_ = nullptr;
};

}  // namespace racebeam
