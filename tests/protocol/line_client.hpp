// A client of the line protocol without a wire.
#pragma once

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "protocol/line_session.hpp"
#include "tests/protocol/description/reply_schema.hpp"

namespace racebeam::test {

inline const std::string kLoad = "load beamfall seed=7 sticky=0";  // the same play whenever it is said

inline LineService line_service(const LineLimits& limits = {}) {
  LineService service;
  service.version = "test";
  service.images = std::make_shared<const Images>();
  service.limits = limits;
  return service;
}

class LineClient {
 public:
  explicit LineClient(const LineService& with = line_service()) : service(with), session(service) {}

  // Sends the text. Returns all output.
  std::string say(std::string_view text) {
    std::string answers;
    while (!text.empty()) {
      const std::span<char> space = session.space();
      const std::size_t count = std::min(space.size(), text.size());
      std::copy_n(text.begin(), count, space.begin());
      if (count > 0) session.received(count);
      text.remove_prefix(count);
      answers += listen();
    }
    return answers;
  }

  // Sends the text, without executing requests. There must be space for it.
  void hand_in(std::string_view text) {
    while (!text.empty()) {
      if (session.space().empty()) session.run(std::chrono::microseconds(0));  // makes space for the line
      const std::size_t count = std::min(session.space().size(), text.size());
      if (count == 0) throw std::length_error("the session has no space for more input");
      std::copy_n(text.begin(), count, session.space().begin());
      session.received(count);
      text.remove_prefix(count);
    }
  }

  // Sends one request. Returns its reply without LF. Throws std::logic_error if protocol.toml describes
  // another one.
  std::string ask(const std::string& request) {
    std::string answer = say(request + "\n");
    if (!answer.empty()) answer.pop_back();
    check_reply(request, answer);
    return answer;
  }

  std::string close() {
    session.received(0);
    return listen();
  }

  std::string listen() {
    std::string answers;
    bool more = true;
    while (more) {
      more = session.run();
      answers += session.output();
      session.sent(session.output().size());
    }
    return answers;
  }

  LineService service;
  LineSession session;
};

// The value of `key` in the `group`th part of a reply.
inline std::string value(std::string_view reply, const std::string& key, int group = 0) {
  for (; group > 0; --group) reply.remove_prefix(reply.find(" |") + 2);
  reply = reply.substr(0, reply.find(" |"));
  const std::string mark = " " + key + "=";
  const std::size_t at = reply.find(mark);
  if (at == std::string_view::npos) return "(none)";
  reply.remove_prefix(at + mark.size());
  return std::string(reply.substr(0, reply.find(' ')));
}

// The code of an error; "" for ok.
inline std::string code(const std::string& reply) {
  if (!reply.starts_with("error ")) return "";
  return reply.substr(6, reply.find(' ', 6) - 6);
}

}  // namespace racebeam::test
