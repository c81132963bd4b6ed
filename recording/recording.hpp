// Frames on their way to the disk. The thread that plays copies each frame into a short queue; a thread of
// the Recorder encodes and writes it. So neither zlib nor a disk that hangs holds up those who play.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
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
  std::vector<std::uint8_t> pixels;  // none where only sound is recorded
  std::array<std::uint8_t, 6> sound;
};

// What is recorded, and where.
struct Order {
  std::vector<MediaKind> kinds;  // at least one, each once
  std::string folder, name;
  std::size_t most_bytes;  // of all files together
  Footage footage;
  std::shared_ptr<const void> charge = nullptr;  // let go of when the recording's memory is

  std::vector<std::string> file_names() const;  // one for each kind
  std::size_t memory() const;                   // bytes of the queue and the encoders, at most
};

// Charges so many bytes of memory to an account, for as long as what it returns is held; throws if there are
// not so many.
using Charge = std::function<std::shared_ptr<const void>(std::size_t bytes)>;

class Recording : public std::enable_shared_from_this<Recording> {
 public:
  // Why it ended before it was told to. What was written before is kept.
  enum class Cut { kLimit, kDisk };

  struct Result {
    std::string names;  // of the files that were kept, such as "a.gif" or "a.y4m,a.wav"; empty: none were
    std::int64_t frames = 0;
    std::size_t bytes = 0;
    std::string failure;  // what the disk refused; a sentence
  };

  // Runs its jobs one after the other, in their order, on another thread.
  using Post = std::function<void(std::function<void()>)>;

  // Recorder::begin() makes one. `given_up`: nothing more is written, and nothing kept.
  Recording(Order order, std::unique_ptr<Claim> claim, Post post,
            std::shared_ptr<const std::atomic<bool>> given_up);
  void begin();

  // Whether it has yet to begin, to make room for a frame, or to finish, whichever was asked for last. The
  // caller waits until it is not. From any thread.
  bool is_behind() const;

  // One frame: a copy of its screen. Not while it is behind; one thread at a time. Does nothing after a cut.
  void add(const Environment& machine);

  void finish();                                       // there are no more frames: keeps what there is
  bool finished() const;                               // nothing happens any more; from any thread
  std::optional<Cut> cut() const;                      // from any thread
  const Result& result() const { return result_; }     // once it has finished
  const std::string& names() const { return names_; }  // of its files: "a.gif", "a.y4m,a.wav"

 private:
  // On the recorder's threads.
  void open();
  void write_next();
  void write(const RecordedFrame& frame);
  void cut_off(Cut why);
  void close();
  void keep();
  void end();

  void post(void (Recording::*job)());
  bool is_over() const;  // no frame is taken any more
  template <typename Change>
  void change(Change change);  // under the mutex

  const Order order_;
  const std::string names_;
  const bool has_pictures_;
  const Post post_;
  const std::shared_ptr<const std::atomic<bool>> given_up_;

  std::vector<RecordedFrame> queue_;  // a ring; a frame belongs to the recorder's thread while it waits
  std::size_t added_ = 0;             // of the thread that plays

  // Of the recorder's threads.
  DiskBudget budget_;
  std::vector<std::unique_ptr<Media>> media_;  // as order_.kinds; empty when nothing is written any more
  Sound sound_;                                // of its own: what is recorded must not change what is played
  std::unique_ptr<Claim> claim_;
  std::size_t written_ = 0;
  Result result_;

  mutable std::mutex mutex_;
  std::size_t waiting_ = 0;  // frames in the queue
  bool begun_ = false, finishing_ = false, ended_ = false;
  std::optional<Cut> cut_;
};

std::string_view name_of(Recording::Cut cut);  // limit, disk

}  // namespace racebeam
