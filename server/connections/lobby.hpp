// Sessions whose clients have yet to give a token, in the order in which they came. Where there are as many
// sessions as there may be, the first of them makes room.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>  // Asio 1.74 forgets it

namespace racebeam {

class Client;

// From any thread.
class Lobby : public std::enable_shared_from_this<Lobby> {
 public:
  // A client's, from its first byte to its token, or to its end.
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

  void enter(const std::shared_ptr<Client>& client);  // on the thread that has made it

  // Ends the session that has been without a token for longest, with this sentence. False: all have given
  // one.
  bool make_room(const std::string& sentence);

 private:
  void leave(std::uint64_t number);
  std::shared_ptr<Client> take_first();  // null: there is none

  std::mutex mutex_;
  std::uint64_t entered_ = 0;
  std::map<std::uint64_t, std::weak_ptr<Client>> waiting_;  // by when they came
};

}  // namespace racebeam
