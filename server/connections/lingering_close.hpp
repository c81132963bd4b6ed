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

// Closing a socket with unread input would make the system discard output that the client has not read yet.
Task<> close_gently(std::shared_ptr<Client> client);

// Closes the connection, after a last text, which may be empty. `gently`: waits for the client's end, so that
// the text is certain to arrive.
Task<> turn_away(std::shared_ptr<Client> client, std::string text, bool gently);

}  // namespace racebeam
