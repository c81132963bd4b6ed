// A lingering close: the server reads on until the client closes its end, so that its last output arrives.
#pragma once

#include <memory>
#include <string>
#include <utility>  // needed by Asio 1.74

#include "server/connections/client.hpp"

namespace racebeam {

// Limits how long a client may take to close its end.
class CloseTimer {
 public:
  explicit CloseTimer(const std::shared_ptr<Client>& client);

 private:
  boost::asio::steady_timer timer_;
};

// Closes the sending end, and reads until the client closes its end. Closing a socket with unread input would
// make the system discard output that the client has not read yet.
Task<> lingering_close(std::shared_ptr<Client> client);

// Sends a last text, which may be empty, and closes the connection. lingering: closes it by
// lingering_close(), so that the text is certain to arrive.
Task<> refuse_connection(std::shared_ptr<Client> client, std::string text, bool lingering);

}  // namespace racebeam
