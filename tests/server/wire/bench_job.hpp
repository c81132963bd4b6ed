// The job of a wire benchmark, and the session without a wire that it is compared with.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "protocol/line_session.hpp"

namespace wire {

using Lines = std::vector<std::string>;

struct Job {
  std::string racebeam, image;
  Lines preparation;
  int steps, ahead;
  Lines requests;          // each an act, or a reset
  bool one_write = false;  // the client sends all that it may send in one write; else in one each
};

// Requests, each an act or a step. Every action is held for some requests, as players do.
Lines draw_requests(int count, const std::string& command);

std::string load_of(const std::string& image);  // the request, without LF

// An act after the end of an episode runs no frame, so a reset replaces it.
void reset_where_it_ends(Job& job);

// Requests in, replies into a string.
class LocalSession {
 public:
  explicit LocalSession(const Job& job);  // prepared

  void ask(const std::string& request);                         // throws std::runtime_error
  std::string_view reply() const { return session_.output(); }  // valid until the next request

 private:
  racebeam::LineService service_;
  racebeam::LineSession session_;
};

}  // namespace wire
