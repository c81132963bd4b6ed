// What the sessions of the line protocol share, and the limits of one client.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "emulator/translator/translator.hpp"
#include "games/images.hpp"
#include "protocol/line/old_words.hpp"
#include "protocol/line/share.hpp"
#include "protocol/running/disposal.hpp"
#include "protocol/running/memory_budget.hpp"

namespace racebeam {

class Recorder;

// Limits of one client, as `hello` reports them.
struct LineLimits {
  std::size_t line = 1 << 20;               // bytes of a request; an image of the largest size fits as base64
  std::size_t output = 1 << 18;             // bytes that wait to be sent; above them, no request is begun
  std::size_t reply = 96 << 20;             // bytes of a reply, as protocol/PROTOCOL.md counts them
  int machines = 256;                       // of `open`
  int states = 256;                         // saved at the same time
  std::int64_t request_frames = 2'000'000;  // of one request
  std::size_t recording = 1 << 30;          // bytes of one recording
  std::int64_t idle_seconds = 0;            // timeout without a byte; 0: never
};

// Runs task(0) ... task(count - 1), possibly on several threads, and returns when all are done. A task must
// not throw.
using Parallel = std::function<void(std::size_t count, const std::function<void(std::size_t)>& task)>;

// Whether a token is one of the server's. Thread-safe.
using Admission = std::function<bool(std::string_view token)>;

// What all sessions of a server share. All of it is const or thread-safe.
struct LineService {
  std::string version = "0";
  std::shared_ptr<const Images> images;
  LineLimits limits;
  std::shared_ptr<Recorder> recorder;    // null: recording is off
  Parallel parallel;                     // empty: tasks run one after the other
  std::size_t threads = 1;               // of `parallel`
  Admission admission;                   // empty: no token is required
  CpuKind cpu = CpuKind::kAuto;          // of all machines
  std::shared_ptr<MemoryBudget> memory;  // of all sessions; null: unlimited
  std::shared_ptr<Disposal> disposal;    // of what sessions leave; null: they destroy it themselves
  bool strict = false;                   // the first error ends a session; for scripts
  std::shared_ptr<Shares> shares = std::make_shared<Shares>();
  bool share_all = false;  // sessions are shared from their first game on
  // Reports an `internal` error; thread-safe; may be empty.
  std::function<void(const std::string& sentence)> report_fault;
  std::shared_ptr<UsedOldWords> old_words = std::make_shared<UsedOldWords>();
  // Reports an old word of a request, at its first use; thread-safe; may be empty.
  std::function<void(const std::string& sentence)> report_old_word;
};

}  // namespace racebeam
