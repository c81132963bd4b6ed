// One request over HTTP, and its response.
#pragma once

#include <optional>
#include <utility>  // needed by Asio 1.74

#include <boost/beast/core/flat_buffer.hpp>

#include "server/scheduling/task.hpp"
#include "server/web/byte_stream.hpp"
#include "server/web/site.hpp"

namespace racebeam {

struct Exchange {
  bool open = false;                   // another request may follow
  std::optional<HttpRequest> session;  // set if the request opens a session; it has no response yet
};

// Receives a request, and answers it unless it opens a session. Neither is open after bytes that are not
// HTTP, and when the client has closed the connection. `buffer` keeps what follows the request.
Task<Exchange> exchange(ByteStream& stream, boost::beast::flat_buffer& buffer, const Site& site);

}  // namespace racebeam
