// The argument of command handlers: the state of one session, and the limits of a request.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "emulator/translator/code_owner.hpp"
#include "protocol/line/line_service.hpp"
#include "protocol/line/loaded_machine.hpp"
#include "protocol/line/machines.hpp"
#include "protocol/line/states.hpp"
#include "protocol/line/watching.hpp"
#include "protocol/running/memory_budget.hpp"
#include "protocol/running/pacer.hpp"

namespace racebeam {

class Recording;
class SessionLog;
class SessionRecording;

// Frames that a machine may run beyond those of the request. Power-on and an ordinary reset take about 130.
constexpr std::int64_t kFreeResetFrames = 1000;

struct Statistics {
  std::int64_t requests = 0, errors = 0, acts = 0, frames = 0, episodes = 0, bytes_in = 0, bytes_out = 0;
};

struct Peer {            // the client
  bool admitted = true;  // it gave a valid token, or none is needed
  int wrong_tokens = 0;  // how many it gave
  int columns = 0;       // width of its terminal if a person types; 0: it is a program
  bool quitting = false;
};

struct LoadedGame {
  Cartridge cartridge;
  std::unique_ptr<CodeOwner> own_image;  // null: the image is the server's
  PlaySettings settings;
  std::unique_ptr<LoadedMachine> loaded;  // null: no game is loaded
  States states;
  std::int64_t episode = 1;  // of the loaded machine, from 1
  int last_action = 0;       // of player A, played on it
};

struct SessionMedia {
  std::unique_ptr<SessionRecording> recording;  // null if nothing is being recorded
  std::shared_ptr<Recording> picture;           // that the request writes; null if it writes none
  std::unique_ptr<SessionLog> log;              // null if no episodes are logged
};

struct Scratch {  // of the current request; members to reuse their memory
  std::vector<Action> actions;
  std::vector<Act> acts;  // of `step`
};

class Context {
 public:
  Context(const LineService& with, const std::shared_ptr<MemoryBudget>& budget);
  ~Context();  // in another file, since SessionRecording is incomplete here

  const LineService& service;
  Peer peer;
  Statistics statistics;
  Pacer pacer;                // each request runs as its body
  MemoryShare memory;         // of the server's budget; a request checks it before it allocates
  std::vector<Field> fields;  // selected by `observe`; they persist across `load`
  LoadedGame game;
  SessionMedia media;
  std::unique_ptr<Sharing> sharing;  // null if the session is not shared
  Watching watching;                 // shared sessions that this one watches
  Scratch scratch;
  Machines machines;

  // Throws RequestError if these acts, and these frames in addition, exceed --max-request-frames.
  void check_frames(std::int64_t acts, std::int64_t frames = 0) const;
  // As check_frames(), for acts whose complete sound is in the reply.
  void check_audio(std::int64_t acts) const;
  // Lets the request reset this many machines. The pacer then stops it at the frames that it may run.
  void allow_resets(std::size_t machines);
  // Throws RequestError if a reply of this estimated length would exceed the limit. `about` is its subject.
  void check_reply(std::size_t bytes, const std::string& about) const;
  void count(const Outcome& outcome);  // adds it to the statistics
  // Empties an object of about this many bytes. If it is large, another thread destroys its content.
  template <typename T>
  void discard(T& object, std::size_t bytes) {
    dispose(service.disposal, service.memory, bytes, std::exchange(object, T()));
  }
  void discard(std::string& text);
  // Ends a recording or a log of machines of `open` before they are destroyed.
  void stop_recording_machines();
  // Spoils the log of the loaded machine's episode, which something other than acts changed.
  void drop_log(std::string why);
  void run_parallel(std::size_t count, const std::function<void(std::size_t)>& task) const;

  // These act on the session, not on a request:
  void publish();                 // to watchers
  void leave();                   // ends everything that other sessions can see
  void release_caches();          // releases what the next request can make again
  bool waits_for_disk() const;    // a recording has no room for another frame
  std::size_t footprint() const;  // bytes of memory
};

}  // namespace racebeam
