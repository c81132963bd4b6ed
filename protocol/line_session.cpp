#include "protocol/line_session.hpp"

#include "protocol/line/commands/command_table.hpp"
#include "protocol/line/session.hpp"

namespace racebeam {
LineSession::LineSession(const LineService& service, Meter* meter,
                         const std::shared_ptr<MemoryBudget>& memory)
    : session_(std::make_unique<Session>(service, command_table(), meter, memory)) {}

LineSession::~LineSession() {
  session_->leave();
  const auto disposal = session_->context().service.disposal;
  const std::size_t bytes = session_->context().memory.bytes();
  dispose(disposal, nullptr, bytes, std::move(session_));
}

void LineSession::set_columns(int columns) { session_->context().peer.columns = columns; }
std::size_t LineSession::longest_line() const { return session_->input().longest(); }
std::span<char> LineSession::space() { return session_->input().space(); }

void LineSession::received(std::size_t count) {
  session_->input().added(count);
  if (count == 0) session_->input().end();
}

bool LineSession::run(std::chrono::microseconds slice) { return session_->run(slice); }

std::chrono::steady_clock::duration LineSession::worked() const { return session_->worked(); }

bool LineSession::waits() const { return session_->waits(); }

std::string_view LineSession::output() const { return session_->whole_replies(); }

void LineSession::sent(std::size_t count) { session_->sent(count); }

bool LineSession::admitted() const { return session_->context().peer.admitted; }
bool LineSession::refused() const { return session_->refused(); }
int LineSession::wrong_tokens() const { return session_->context().peer.wrong_tokens; }
bool LineSession::finished() const { return session_->finished(); }
void LineSession::cancel() { session_->cancel(); }
void LineSession::release_caches() { session_->release_caches(); }

std::string LineSession::summary() const {
  const Statistics& all = session_->context().statistics;
  const std::string_view denied = admitted() ? "" : ", without a token";
  return std::to_string(all.requests) + " requests, " + std::to_string(all.frames) + " frames, " +
         std::to_string(all.errors) + " errors" + std::string(denied);
}

}  // namespace racebeam
