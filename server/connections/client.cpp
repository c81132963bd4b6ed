#include "server/connections/client.hpp"

#include <algorithm>

#include "server/connections/owner.hpp"

namespace racebeam {

using namespace std::chrono_literals;

Client::Client(Socket connection, Loop& home, std::string who, const std::shared_ptr<MemoryBudget>& budget,
               std::size_t bytes)
    : socket(std::move(connection)),
      loop(home),
      name(std::move(who)),
      budget_(budget ? std::make_shared<MemoryBudget>(MemoryBudget::part(budget, owner_of(socket)))
                     : nullptr),
      carrier_(budget_) {
  carrier_.set(bytes);
  ++loop.sessions;
}

Client::~Client() { --loop.sessions; }

void Client::enter_loop() { loop.clients.insert(this); }
void Client::leave_loop() { loop.clients.erase(this); }

void Client::received(std::size_t bytes) {
  const auto answered = active_;
  mark_active();
  quick_ = loop.busy.received_after(active_ - answered);
  loop.meter.bytes_in.add(static_cast<std::int64_t>(bytes));
}

void Client::begin_sending(std::size_t bytes) {
  unsent_ = bytes;
  sends_since_ = Clock::now();
}

void Client::sent(std::size_t bytes) {
  mark_active();
  unsent_ -= std::min(unsent_, bytes);
  loop.meter.bytes_out.add(static_cast<std::int64_t>(bytes));
  if (quick_) loop.busy.begin();
}

void Client::release_caches() {
  if (on_idle && !std::exchange(caches_released_, true)) on_idle();
}

void Client::end(ErrorCode code, const std::string& sentence) {
  boost::system::error_code ignored;
  if (ending()) {
    if (Clock::now() - ended_ > 2s) socket.close(ignored);
    return;
  }
  std::string farewell = "error ";
  (((farewell += name_of(code)) += ' ') += sentence) += '\n';
  reason_ = sentence;
  ended_ = Clock::now();
  code_ = code;
  farewell_ = std::move(farewell);
  socket.cancel(ignored);
}

}  // namespace racebeam
