#include "server/connections/lobby.hpp"

#include <boost/asio/post.hpp>

#include "server/connections/client.hpp"

namespace racebeam {

void Lobby::enter(const std::shared_ptr<Client>& client) {
  const std::lock_guard lock(mutex_);
  client->place.emplace(shared_from_this(), ++entered_);
  waiting_.emplace(entered_, client);
}

bool Lobby::make_room(const std::string& sentence) {
  auto client = take_first();
  if (!client) return false;
  auto& context = client->loop.context;
  boost::asio::post(context, [lobby = shared_from_this(), client = std::move(client), sentence] {
    if (client->admitted) {
      lobby->make_room(sentence);
    } else {
      client->end(ErrorCode::kBusy, sentence);
    }
  });
  return true;
}

void Lobby::leave(std::uint64_t number) {
  const std::lock_guard lock(mutex_);
  waiting_.erase(number);
}

std::shared_ptr<Client> Lobby::take_first() {
  const std::lock_guard lock(mutex_);
  std::shared_ptr<Client> client;
  while (!client && !waiting_.empty()) {
    client = waiting_.begin()->second.lock();
    waiting_.erase(waiting_.begin());
  }
  return client;
}

}  // namespace racebeam
