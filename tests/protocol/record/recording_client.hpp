// A client of a service that records into a scratch folder.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "recording/recorder.hpp"
#include "tests/games/scratch.hpp"
#include "tests/protocol/line_client.hpp"
#include "tests/recording/film.hpp"

namespace racebeam::test {

struct RecordingClient {
  static constexpr std::uint64_t kMemory = 64 << 20;

  RecordingClient(LineService plain, const std::string& load, std::size_t most_bytes)
      : client(recording(std::move(plain), most_bytes)) {
    client.ask(load);
  }

  LineService recording(LineService service, std::size_t most_bytes) const {
    service.limits.recording = most_bytes;
    service.recorder = std::make_shared<Recorder>(folder.path(""));
    service.memory = std::make_shared<MemoryBudget>(kMemory);
    return service;
  }

  std::string ask(const std::string& request) { return client.ask(request); }
  std::string file(const std::string& name) const { return test::read(folder.path(name)); }

  Scratch folder;
  LineClient client;
};

}  // namespace racebeam::test
