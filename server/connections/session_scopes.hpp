// What begins with a session and ends with it, on every way out of its coroutine.
#pragma once

#include <functional>
#include <memory>
#include <utility>  // needed by Asio 1.74

#include "protocol/classic/paced_classic.hpp"
#include "protocol/running/disposal.hpp"
#include "server/connections/client.hpp"

namespace racebeam {

// The client is one of its loop's clients.
class Presence {
 public:
  explicit Presence(Client& client) : client_(client) { client.enter_loop(); }
  ~Presence() { client_.left(); }
  Presence(const Presence&) = delete;
  Presence& operator=(const Presence&) = delete;

 private:
  Client& client_;
};

// The session releases its caches in a pause.
class Resting {
 public:
  Resting(Client& client, std::function<void()> rest) : client_(client) { client_.on_rest = std::move(rest); }
  ~Resting() { client_.on_rest = nullptr; }
  Resting(const Resting&) = delete;
  Resting& operator=(const Resting&) = delete;

 private:
  Client& client_;
};

// A session of the classic protocol. It may leave thousands of states, which `disposal` of the service
// destroys.
class ClassicPlace {
 public:
  ClassicPlace(const ClassicService& service, const std::shared_ptr<MemoryBudget>& memory)
      : disposal_(service.disposal), session_(std::make_unique<PacedClassic>(service, memory)) {}
  ~ClassicPlace() {
    session_->leave();
    const std::size_t bytes = session_->bytes();
    dispose(disposal_, nullptr, bytes, std::move(session_));
  }
  ClassicPlace(const ClassicPlace&) = delete;
  ClassicPlace& operator=(const ClassicPlace&) = delete;

  PacedClassic& session() { return *session_; }

 private:
  const std::shared_ptr<Disposal> disposal_;
  std::unique_ptr<PacedClassic> session_;
};

}  // namespace racebeam
