#include "tests/server/wire/bench_job.hpp"

#include <algorithm>
#include <filesystem>
#include <memory>
#include <random>
#include <stdexcept>

namespace wire {
namespace {

using racebeam::Images;
using racebeam::LineService;

std::string name_of(const std::string& image) {
  return image.starts_with("builtin:") ? image.substr(8) : std::filesystem::path(image).stem().string();
}

LineService serve(const std::string& image) {
  auto images = std::make_shared<Images>();
  images->add_file(image);
  LineService service;
  service.images = images;
  return service;
}

}  // namespace

Lines draw_requests(int count, const std::string& command) {
  std::mt19937 random(1);
  Lines requests;
  int action = 0;
  for (int i = 0; i < count; ++i) {
    if (random() % 4 == 0) action = static_cast<int>(random() % 6);
    requests.push_back(command + " " + std::to_string(action) + "\n");
  }
  return requests;
}

std::string load_of(const std::string& image) {
  return "load " + name_of(image) + " seed=1 sticky=0 max_episode_frames=0";
}

void reset_where_it_ends(Job& job) {
  LocalSession session(job);
  bool over = false;
  for (std::string& request : job.requests) {
    if (over) request = "reset\n";
    session.ask(request);
    over = session.reply().find(" terminated=1") != std::string_view::npos;
  }
}

LocalSession::LocalSession(const Job& job) : service_(serve(job.image)), session_(service_) {
  for (const std::string& request : job.preparation) ask(request);
}

void LocalSession::ask(const std::string& request) {
  session_.sent(session_.output().size());
  const auto space = session_.space();
  std::copy_n(request.begin(), request.size(), space.begin());
  session_.received(request.size());
  while (session_.run()) continue;
  if (!reply().starts_with("ok")) throw std::runtime_error(std::string(reply()));
}

}  // namespace wire
