// What the sessions of the line protocol share, and what one client may use.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "emulator/translator/translator.hpp"
#include "protocol/line/images.hpp"
#include "protocol/running/memory_budget.hpp"

namespace racebeam {

class Recorder;

// What one client may use. `hello` tells.
struct LineLimits {
  std::size_t line = 1 << 20;               // bytes of a request; an image of the largest size fits as base64
  std::size_t output = 1 << 18;             // bytes that wait for the reader; above, no request is begun
  std::size_t reply = 1 << 26;              // bytes of a reply that one may ask for, as protocol/PROTOCOL.md counts
  int machines = 256;                       // of `open`
  int states = 256;                         // saved at a time
  std::int64_t request_frames = 2'000'000;  // that one request may ask for
  std::size_t recording = 1 << 30;          // bytes of one recording
  std::int64_t idle_seconds = 0;            // without a word, after which the server ends it; 0: never
};

// Runs task(0) ... task(count - 1), on several threads if it likes, and returns when all are done. A task
// does not throw.
using Parallel = std::function<void(std::size_t count, const std::function<void(std::size_t)>& task)>;

// Whether a token is one of those that the server knows. From any thread.
using Admission = std::function<bool(std::string_view token)>;

// What all sessions of a server share, all of it const, or made for many threads.
struct LineService {
  std::string version = "0";
  std::shared_ptr<const Images> images;
  LineLimits limits;
  std::shared_ptr<Recorder> recorder;  // null: nothing is recorded
  Parallel parallel;                   // empty: one after the other
  std::size_t threads = 1;             // that `parallel` has
  Admission admission;                 // empty: everyone may play; else whose `hello` gives a token
  CpuKind cpu = CpuKind::kAuto;        // of all machines
  std::shared_ptr<MemoryBudget> memory;  // of all sessions; null: there is no limit
  bool strict = false;           // the first error ends a session; for scripts
  std::function<void(const std::string& sentence)> report_fault;  // an `internal` error; from any thread; may be empty
};

}  // namespace racebeam
