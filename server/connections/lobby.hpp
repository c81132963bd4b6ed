// Sessions whose clients have not given a token yet, in the order of their arrival. When the limit of
// sessions is reached, the first of them is closed.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>  // needed by Asio 1.74

namespace racebeam {

class Client;

// Thread-safe.
class Lobby : public std::enable_shared_from_this<Lobby> {
 public:
  // A client's place. It is held until the client gives its token, or leaves.
  class Place {
   public:
    Place(std::shared_ptr<Lobby> lobby, std::uint64_t number) : lobby_(std::move(lobby)), number_(number) {}
    ~Place() { lobby_->leave(number_); }
    Place(const Place&) = delete;
    Place& operator=(const Place&) = delete;

   private:
    const std::shared_ptr<Lobby> lobby_;
    const std::uint64_t number_;
  };

  void enter(const std::shared_ptr<Client>& client);  // on the thread that has made `client`

  // Ends the session that has been without a token for longest, with this sentence as the error. Returns
  // false if all sessions have given a token. If that session gives its token meanwhile, it stays, and the
  // next one is ended. If it was the last one, the server has one session more than its limit for a while.
  bool make_room(const std::string& sentence);

 private:
  void leave(std::uint64_t number);
  std::shared_ptr<Client> take_first();  // null: the lobby is empty

  std::mutex mutex_;
  std::uint64_t entered_ = 0;
  std::map<std::uint64_t, std::weak_ptr<Client>> waiting_;  // by order of arrival
};

}  // namespace racebeam
