// Frames on their way to the disk. The playing thread copies each frame into a short queue. A thread of the
// Recorder encodes and writes it. So neither zlib nor a hanging disk delays the playing thread.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "emulator/tia/sound.hpp"
#include "environment/environment.hpp"
#include "recording/claim.hpp"
#include "recording/media.hpp"

namespace racebeam {

struct RecordedFrame {
  std::vector<std::uint8_t> pixels;  // empty if only sound is recorded
  std::array<std::uint8_t, 6> sound;
};

// What is recorded, and where.
struct Order {
  std::vector<MediaKind> kinds;  // at least one kind, each at most once
  std::string folder, name;
  std::size_t most_bytes;  // of all files together
  Footage footage;
  std::shared_ptr<const void> charge = nullptr;  // released with the recording's memory

  std::vector<std::string> file_names() const;  // one for each kind
  std::size_t memory() const;                   // bytes of the queue and the encoders, at most
};

// Charges bytes of memory to an account, until the returned object is released. Throws if the account does
// not have as many.
using Charge = std::function<std::shared_ptr<const void>(std::size_t bytes)>;

class Recording : public std::enable_shared_from_this<Recording> {
 public:
  // Why the recording ended early. The frames before that are committed.
  enum class Cut { kLimit, kDisk, kEncoder };

  struct Result {
    std::string names;  // of the committed files, such as "a.gif" or "a.y4m,a.wav"; empty: none
    std::int64_t frames = 0;
    std::size_t bytes = 0;
    std::string failure;  // the system's error, as a sentence
  };

  // Runs jobs one after the other, in their order, on another thread.
  using Post = std::function<void(std::function<void()>)>;

  // Recorder::begin() calls it. When `given_up` is set, nothing more is written or committed.
  Recording(Order order, std::unique_ptr<Claim> claim, Post post,
            std::shared_ptr<const std::atomic<bool>> given_up);
  void begin();

  // Whether the last call of begin(), add() or finish() has not been completed. The caller waits until it
  // has. Thread-safe.
  bool is_behind() const;

  // Adds one frame: a copy of the machine's screen and sound. Must not be called while is_behind(), and only
  // by one thread at a time. Does nothing after a cut.
  void add(const Environment& machine);

  void finish();                                       // after the last frame: commits the files
  bool finished() const;                               // all work is done; thread-safe
  std::optional<Cut> cut() const;                      // thread-safe
  const Result& result() const { return result_; }     // once it has finished
  const std::string& names() const { return names_; }  // of its files: "a.gif", "a.y4m,a.wav"

 private:
  // On the recorder's threads:
  void open();
  void write_next();
  void write(const RecordedFrame& frame);
  void cut_off(Cut why);
  void fail(Cut why, const std::exception& error);
  void close();
  void commit();
  void end();

  void post(void (Recording::*job)());
  bool is_over() const;  // whether the recording refuses further frames
  template <typename Change>
  void change(Change change);  // makes the change under the mutex

  const Order order_;
  const std::string names_;
  const bool has_pictures_;
  const Post post_;
  const std::shared_ptr<const std::atomic<bool>> given_up_;

  std::vector<RecordedFrame> queue_;  // a ring; frames that wait belong to the recorder's thread
  std::size_t added_ = 0;             // frames that the playing thread has added

  // Used by the recorder's threads:
  DiskBudget budget_;
  // In the order of order_.kinds. Empty when nothing more is written.
  std::vector<std::unique_ptr<Media>> media_;
  Sound sound_;  // a copy: recording must not change what is played
  std::unique_ptr<Claim> claim_;
  std::size_t written_ = 0;
  Result result_;

  mutable std::mutex mutex_;
  std::size_t waiting_ = 0;  // frames in the queue
  bool has_begun_ = false, finishing_ = false, ended_ = false;
  std::optional<Cut> cut_;
};

std::string_view name_of(Recording::Cut cut);  // limit, disk, encoder

}  // namespace racebeam
