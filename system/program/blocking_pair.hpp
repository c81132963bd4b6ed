// Blocking input and output for a thread that does nothing else: a descriptor to read from, and one to write
// to. Another thread can wake it up.
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

// Named pipes, which are files. Windows does not have them.
enum class PathKind { kMissing, kPipe, kOther };
PathKind kind_of_path(const std::string& path);
bool make_pipe(
    const std::string& path);  // for this user; returns false if it fails, and errno has the reason
bool is_pipe(int descriptor);  // also true for a socket

// How another thread stops the one that uses a BlockingPair.
struct Halt {
  std::atomic<bool> reading = false;  // nothing more is to be read
  std::atomic<bool> all = false;      // nothing more is to be done

  // Interrupts the system call that the thread waits in. The caller repeats it, since it may come just before
  // the system call.
  static void wake(std::jthread& thread);
  static void prepare();  // must be called once in a process, before wake()
};

class BlockingPair {
 public:
  BlockingPair(const Halt& halt, std::chrono::microseconds busy_poll) : halt_(halt), busy_(busy_poll) {}
  ~BlockingPair();
  BlockingPair(const BlockingPair&) = delete;
  BlockingPair& operator=(const BlockingPair&) = delete;

  void use(int in, int out);
  // Both open a named pipe, and wait until the client opens its other end. They return false if they were
  // halted, and throw std::runtime_error if that fails. makes_file: if `path` is not a pipe, open_out()
  // creates a file, or empties the one that exists.
  bool open_out(const std::string& path, bool makes_file);
  bool open_in(const std::string& path);

  std::size_t read(std::span<char> space);  // 0: the end, or it was halted
  // Reads without waiting. Returns nothing if no input has come, or if the system cannot tell.
  std::optional<std::size_t> read_at_once(std::span<char> space);
  bool write(std::string_view text);          // false: the client does not read any more, or it was halted
  void write_at_once(std::string_view text);  // writes a short text if there is room for it now
  bool reader_left() const;                   // without waiting

 private:
  bool open(int& descriptor, const std::string& path, int flags);

  std::optional<std::size_t> read_awake(std::span<char> space);  // nothing: no input has come
  std::size_t read_asleep(std::span<char> space);

  const Halt& halt_;
  BusyPoll busy_;
  bool quick_ = false;  // the last input came soon after read() had begun to wait
  int in_ = -1, out_ = -1;
};

}  // namespace racebeam
