#include "server/access/resolve.hpp"

#include <boost/asio/io_context.hpp>

namespace racebeam {

namespace net = boost::asio;
using net::ip::tcp;

tcp::endpoint resolve(const TcpAddress& address) {
  net::io_context context;
  boost::system::error_code error;
  const auto found = tcp::resolver(context).resolve(address.host, std::to_string(address.port),
                                                    tcp::resolver::numeric_service, error);
  if (error || found.empty()) {
    throw AddressError("the host of " + to_string(Address(address)) +
                       " is unknown: " + (error ? error.message() : "it has no address"));
  }
  return *found.begin();
}

}  // namespace racebeam
