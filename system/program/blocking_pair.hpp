// Two descriptors, one to read from and one to write to, for a thread that has nothing else to do; it can be
// woken up by another.
#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <thread>

#include "system/busy_poll.hpp"

namespace racebeam {

// Named pipes, which are files. Windows lacks them.
enum class Found { kNothing, kPipe, kOther };
Found look_for_pipe(const std::string& path);
bool make_pipe(const std::string& path);  // for this user; if it fails, errno has the reason
bool is_pipe(int descriptor);             // or a socket

// What another thread wants of the one that waits.
struct Halt {
  std::atomic<bool> reading = false;  // nothing more is to be read
  std::atomic<bool> all = false;      // nothing more is to be done

  // Interrupts the call of the system that the thread is in. It may come just before the call: repeat it.
  static void wake(std::jthread& thread);
  static void prepare();  // before wake(), once in a process
};

class BlockingPair {
 public:
  BlockingPair(const Halt& halt, std::chrono::microseconds busy_poll) : halt_(halt), busy_(busy_poll) {}
  ~BlockingPair();
  BlockingPair(const BlockingPair&) = delete;
  BlockingPair& operator=(const BlockingPair&) = delete;

  void use(int in, int out);
  // Open a named pipe, and wait until the client opens its other end. False if told to halt. Throw
  // std::runtime_error.
  // makes_file: without such a pipe, open_out() makes a file, or empties the one that is there.
  bool open_out(const std::string& path, bool makes_file);
  bool open_in(const std::string& path);

  std::size_t read(std::span<char> space);  // 0: the end, or told to halt
  // Without waiting; nothing: nothing has come, or the system can't tell.
  std::optional<std::size_t> read_at_once(std::span<char> space);
  bool write(std::string_view text);          // false: the client does not read any more, or told to halt
  void write_at_once(std::string_view text);  // a short text, if the client has room for it now
  bool reader_left() const;                   // without waiting

 private:
  bool open(int& descriptor, const std::string& path, int flags);

  std::optional<std::size_t> read_awake(std::span<char> space);  // nothing: nothing has come
  std::size_t read_asleep(std::span<char> space);

  const Halt& halt_;
  BusyPoll busy_;
  bool quick_ = false;  // the other end wrote at once, the last time
  int in_ = -1, out_ = -1;
};

}  // namespace racebeam
