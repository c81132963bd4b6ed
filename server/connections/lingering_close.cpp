#include "server/connections/lingering_close.hpp"

#include <array>

namespace racebeam {

namespace net = boost::asio;
using boost::system::error_code;
using namespace std::chrono_literals;

CloseTimer::CloseTimer(const std::shared_ptr<Client>& client) : timer_(client->socket.get_executor(), 2s) {
  timer_.async_wait([client](error_code cancelled) {
    error_code ignored;
    if (!cancelled) client->socket.close(ignored);
  });
}

Task<> lingering_close(std::shared_ptr<Client> client) {
  error_code error;
  client->socket.shutdown(Socket::shutdown_send, error);
  const CloseTimer timer(client);
  std::array<char, 4096> rest;
  while (!error) {
    co_await client->socket.async_read_some(net::buffer(rest), net::redirect_error(use_task, error));
  }
}

Task<> refuse_connection(std::shared_ptr<Client> client, std::string text, bool lingering) {
  error_code ignored;
  if (!text.empty()) client->socket.write_some(net::buffer(text), ignored);
  if (lingering) co_await lingering_close(client);
}

}  // namespace racebeam
