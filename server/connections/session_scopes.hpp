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
class LoopMembership {
 public:
  explicit LoopMembership(Client& client) : client_(client) { client.enter_loop(); }
  ~LoopMembership() { client_.leave_loop(); }
  LoopMembership(const LoopMembership&) = delete;
  LoopMembership& operator=(const LoopMembership&) = delete;

 private:
  Client& client_;
};

// The session releases its caches in a pause.
class CacheRelease {
 public:
  CacheRelease(Client& client, std::function<void()> release) : client_(client) {
    client_.on_idle = std::move(release);
  }
  ~CacheRelease() { client_.on_idle = nullptr; }
  CacheRelease(const CacheRelease&) = delete;
  CacheRelease& operator=(const CacheRelease&) = delete;

 private:
  Client& client_;
};

// A session of the classic protocol. It may leave thousands of states, which `disposal` of the service
// destroys.
class ClassicSessionScope {
 public:
  ClassicSessionScope(const ClassicService& service, const std::shared_ptr<MemoryBudget>& memory)
      : disposal_(service.disposal), session_(std::make_unique<PacedClassic>(service, memory)) {}
  ~ClassicSessionScope() {
    session_->leave();
    const std::size_t bytes = session_->bytes();
    dispose(disposal_, nullptr, bytes, std::move(session_));
  }
  ClassicSessionScope(const ClassicSessionScope&) = delete;
  ClassicSessionScope& operator=(const ClassicSessionScope&) = delete;

  PacedClassic& session() { return *session_; }

 private:
  const std::shared_ptr<Disposal> disposal_;
  std::unique_ptr<PacedClassic> session_;
};

}  // namespace racebeam
