#include "server/connections/rl_glue_connection.hpp"

#include <boost/asio/connect.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>

#include "server/operation/log.hpp"

namespace racebeam {
namespace {

namespace net = boost::asio;
using boost::system::error_code;
using net::ip::tcp;

constexpr std::uint32_t kMaxPayload = 1 << 20;  // bytes; an action has 16
constexpr std::chrono::milliseconds kBetweenTries{200};

void connect_to(tcp::socket& socket, const tcp::endpoint& core) {
  error_code error;
  for (bool has_logged = false; socket.connect(core, error); has_logged = true) {
    if (!has_logged) log("waiting for an RL-Glue core at 127.0.0.1:" + std::to_string(core.port()));
    socket.close();
    std::this_thread::sleep_for(kBetweenTries);
  }
  socket.set_option(tcp::no_delay(true));
}

// Returns false if the core closed the connection before the first byte.
bool read_whole(tcp::socket& socket, std::string& bytes) {
  error_code error;
  const std::size_t count = net::read(socket, net::buffer(bytes), error);
  if (!error) return true;
  if (error == net::error::eof && count == 0) return false;
  throw std::runtime_error("the connection to the RL-Glue core was lost: " + error.message());
}

void write_whole(tcp::socket& socket, const std::string& bytes) {
  error_code error;
  net::write(socket, net::buffer(bytes), error);
  if (error) throw std::runtime_error("cannot write to the RL-Glue core: " + error.message());
}

}  // namespace

void serve_rl_glue(std::uint16_t port, RlGlueEnvironment& environment) {
  net::io_context context;
  tcp::socket socket(context);
  connect_to(socket, {net::ip::address_v4::loopback(), port});
  write_whole(socket, rl_glue_greeting());
  for (std::string header(kRlGlueHeaderBytes, '\0'); read_whole(socket, header);) {
    const RlGlueHeader next = rl_glue_header(header);
    if (next.size > kMaxPayload) {
      throw std::invalid_argument("the RL-Glue core announced a payload of " + std::to_string(next.size) +
                                  " bytes; at most " + std::to_string(kMaxPayload) + " are accepted");
    }
    std::string payload(next.size, '\0');
    if (!payload.empty() && !read_whole(socket, payload))
      throw std::runtime_error("the connection to the RL-Glue core was lost: a payload is missing");
    const auto answer = environment.answer(next.type, payload);
    if (!answer) return;
    write_whole(socket, *answer);
  }
}

}  // namespace racebeam
