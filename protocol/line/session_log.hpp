// The logging that `log` starts in a session: each episode of its machine becomes a log that can be replayed.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "environment/settings/play_settings.hpp"
#include "environment/vector/slot.hpp"
#include "protocol/running/memory_budget.hpp"
#include "protocol/running/pacer.hpp"
#include "recording/episode_account.hpp"
#include "recording/log_writer.hpp"

namespace racebeam {

class Context;
class Reply;

// The words of `load` with which an episode of this machine can be replayed. `loaded` are those of the
// session.
PlaySettings settings_of_log(const PlaySettings& loaded, const Environment& machine);

// An episode has no log if it was abandoned before its end, if something other than acts of player A changed
// it, or if its settings differ from those of the first.
class SessionLog final : public SlotWatcher {
 public:
  struct Order {
    EpisodeOrigin origin;  // of all logs, except for the episode
    std::string phrase;    // that the seeds follow from; empty: they count up
  };
  struct Counts {
    int logged = 0, unlogged = 0;  // episodes
  };

  // Watches the slot, which outlives it, as `pacer` does, on which it runs. `writer`: null if logs are only
  // handed over. `memory` is that of the server; null: unlimited.
  SessionLog(Order order, const PlaySettings& settings, std::shared_ptr<LogWriter> writer, Slot& slot,
             Pacer& pacer, std::shared_ptr<MemoryBudget> memory);
  ~SessionLog() override;  // keeps what was logged, without waiting for it
  SessionLog(const SessionLog&) = delete;
  SessionLog& operator=(const SessionLog&) = delete;

  bool shows(const Slot& slot) const { return &slot == &slot_; }
  // Suspends the body of `pacer` until all logs are written that were added.
  void await(Pacer& pacer);
  bool is_awaited() const { return is_awaited_ && writer_->is_behind(); }
  LogWriter* writer() { return writer_.get(); }
  const Counts& counts() const { return counts_; }
  void watch() { slot_.set_watcher(this); }  // again
  void drop_log(std::string why);            // the episode, which has no log then
  void leave();                              // the episode, before its end

  // The last episode that ended. Throws RequestError if no episode has ended, or the last one lacks a log.
  const EpisodeLog& last() const;

  // Returns why the writer has stopped: once, as soon as that is known.
  std::optional<Recording::Cut> new_cut();

  std::size_t footprint() const;  // bytes of memory

  std::uint32_t next_seed() override;
  void began() override;
  void played(const Act& act, int frames) override;
  void restored() override { drop_log("a state was restored in it"); }

 private:
  void finish_episode();
  void write(EpisodeLog log);
  std::uint32_t seed_of_phrase_now() const;

  const Order order_;
  const PlaySettings settings_;  // as they were loaded
  const std::string first_settings_;
  const std::shared_ptr<LogWriter> writer_;
  Slot& slot_;
  Pacer& pacer_;
  const std::shared_ptr<MemoryBudget> memory_;

  // Of the episode that is played:
  bool is_playing_ = false;
  EpisodeAccount account_;
  std::vector<std::uint8_t> actions_;
  std::vector<float> strengths_;  // empty as long as all are 1

  std::optional<EpisodeLog> last_;
  std::string why_not_ = "no episode has ended yet";  // why last_ is not that of the last episode
  Counts counts_;
  bool is_awaited_ = false, has_reported_ = false;
};

// Notes in the reply, once, that the session's logs were cut off.
void add_log_cut(Context& context, Reply& reply);

}  // namespace racebeam
