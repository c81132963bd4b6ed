// Two descriptors, one to read from and one to write to, for a thread that has nothing else to do; it can be
// woken up by another.
#pragma once

#include <pthread.h>

#include <atomic>
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace racebeam {

// What another thread wants of the one that waits.
struct Halt {
  std::atomic<bool> reading = false;  // nothing more is to be read
  std::atomic<bool> all = false;      // nothing more is to be done

  // Interrupts the call of the system that the thread is in. It may come just before the call: repeat it.
  static void wake(pthread_t thread);
  static void prepare();  // before wake(), once in a process
};

class BlockingPair {
 public:
  explicit BlockingPair(const Halt& halt) : halt_(halt) {}
  ~BlockingPair();
  BlockingPair(const BlockingPair&) = delete;
  BlockingPair& operator=(const BlockingPair&) = delete;

  void use(int in, int out);
  // Each waits for somebody to open a pipe's other end. False: told to halt. Throws std::runtime_error.
  bool open_out(const std::string& path, int flags);
  bool open_in(const std::string& path);

  std::size_t read(std::span<char> space);  // 0: the end, or told to halt
  bool write(std::string_view text);        // false: the client does not read any more, or told to halt
  bool reader_left() const;                 // without waiting

 private:
  bool open(int& descriptor, const std::string& path, int flags);

  const Halt& halt_;
  int in_ = -1, out_ = -1;
};

}  // namespace racebeam
