// The functions of racebeam.wasm: sessions of the line protocol in one process. ../src/wasm/local.js calls
// them.
#include <cstdint>
#include <memory>
#include <string>

#include "games/images.hpp"
#include "protocol/line_session.hpp"
#include "system/resources.hpp"

#define EXPORTED(name) [[clang::export_name(name)]]

namespace racebeam {
namespace {

LineService make_service() {
  LineService service;
  service.version = RACEBEAM_VERSION;
  service.images = std::make_shared<const Images>();
  service.memory = std::make_shared<MemoryBudget>(usable_memory("").amount / 2);
  return service;
}

std::string replies;  // of the last run()

}  // namespace

EXPORTED("open_session") LineSession* open_session() {
  static const LineService service = make_service();
  return new LineSession(service);
}

EXPORTED("close_session") void close_session(LineSession* session) { delete session; }

// Where the next bytes of requests go: room() of them at most.
EXPORTED("space") char* space(LineSession* session) { return session->space().data(); }
EXPORTED("room") std::uint32_t room(LineSession* session) {
  return static_cast<std::uint32_t>(session->space().size());
}

// Executes the requests of which `count` more bytes, 1 or more, lie in space(). Returns the size of the
// replies, which stay until the next call.
EXPORTED("run") std::uint32_t run(LineSession* session, std::uint32_t count) {
  session->received(count);
  replies.clear();
  for (bool more = true; more;) {
    more = session->run();
    const std::string_view output = session->output();
    replies += output;
    session->sent(output.size());
  }
  return static_cast<std::uint32_t>(replies.size());
}

EXPORTED("replies") const char* last_replies() { return replies.data(); }

// Whether the session has ended, so that it takes no more requests.
EXPORTED("finished") bool finished(LineSession* session) { return session->finished(); }

}  // namespace racebeam
