// A connection, plain or over TLS, as one type. What is built on it is compiled once.
#pragma once

#include <utility>  // needed by Asio 1.74

#include <boost/asio/async_result.hpp>
#include <boost/asio/generic/stream_protocol.hpp>
#include <boost/asio/ssl/stream.hpp>

namespace racebeam {

// Does not own the connection.
class ByteStream {
 public:
  using Socket = boost::asio::generic::stream_protocol::socket;
  using TlsStream = boost::asio::ssl::stream<Socket&>;
  using executor_type = Socket::executor_type;

  explicit ByteStream(Socket& socket) : socket_(&socket) {}
  explicit ByteStream(TlsStream& tls) : socket_(&tls.next_layer()), tls_(&tls) {}

  executor_type get_executor() { return socket_->get_executor(); }

  // As those of the stream beneath.
  template <typename Buffers, typename Token>
  auto async_read_some(const Buffers& buffers, Token&& token) {
    return boost::asio::async_initiate<Token, Signature>(
        [this](auto&& done, const Buffers& space) {
          if (tls_ != nullptr) return tls_->async_read_some(space, std::forward<decltype(done)>(done));
          socket_->async_read_some(space, std::forward<decltype(done)>(done));
        },
        token, buffers);
  }
  template <typename Buffers, typename Token>
  auto async_write_some(const Buffers& buffers, Token&& token) {
    return boost::asio::async_initiate<Token, Signature>(
        [this](auto&& done, const Buffers& bytes) {
          if (tls_ != nullptr) return tls_->async_write_some(bytes, std::forward<decltype(done)>(done));
          socket_->async_write_some(bytes, std::forward<decltype(done)>(done));
        },
        token, buffers);
  }

 private:
  using Signature = void(boost::system::error_code, std::size_t);

  Socket* socket_;
  TlsStream* tls_ = nullptr;
};

}  // namespace racebeam
