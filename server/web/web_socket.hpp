// A WebSocket (RFC 6455) that carries the line protocol: a request line is a text message, and so is a reply.
// The bytes of raw fields follow their line as one binary message.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string_view>
#include <utility>  // needed by Asio 1.74

#include "server/scheduling/task.hpp"
#include "server/web/byte_stream.hpp"
#include "server/web/site.hpp"

namespace racebeam {

// Why the server closes (RFC 6455, 7.4.1).
enum class CloseCode : std::uint16_t {
  kNormal = 1000,
  kGoingAway = 1001,
  kUnsupportedData = 1003,
  kPolicyViolation = 1008,
  kTryAgainLater = 1013
};

class WebSocket {
 public:
  explicit WebSocket(ByteStream stream);
  ~WebSocket();
  WebSocket(const WebSocket&) = delete;
  WebSocket& operator=(const WebSocket&) = delete;

  // Answers the request that opens the WebSocket. Throws std::runtime_error if it is not a valid one.
  Task<> accept(const HttpRequest& request);

  void limit_message(std::size_t bytes);  // a longer one ends the connection

  // Sets a callback for each ping, pong and close that the client sends.
  void on_control(std::function<void()> callback);

  // Receives bytes of request lines; a message that does not end with LF gets one. Returns their number; 0:
  // the client has closed, or what waits was cancelled. Throws std::runtime_error if the client violates the
  // protocol, or sends a binary message.
  Task<std::size_t> read(std::span<char> space);

  // Sends whole replies, in pieces; calls `sent` after each that was accepted. Throws std::runtime_error if
  // the client has stopped reading.
  Task<> write(std::string_view replies, const std::function<void(std::size_t)>& sent);

  // Sends a last line, unless it is empty, and closes. Possible after a cancelled read(). Ignores errors.
  Task<> leave(std::string_view line, CloseCode code);

 private:
  struct Impl;
  Task<> send(std::string_view bytes, bool binary, const std::function<void(std::size_t)>& sent);
  std::size_t complete_line(std::span<char> space, std::size_t count);

  const std::unique_ptr<Impl> impl_;
};

}  // namespace racebeam
