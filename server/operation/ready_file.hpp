// Tells those who wait for a server where it listens: a file with an address a line, there whole or not at
// all. Its first line says what it is. A file that does not begin so is never touched. The server holds a
// lock (flock) on its file for as long as it lives: that of a server that died is told from that of a live
// one.
#pragma once

#include <string>
#include <vector>

#include "server/operation/unlink_on_exit.hpp"

namespace racebeam {

// Removes what a server that died has left: those who wait must not find that one's addresses. That of a live
// server stays. Throws std::runtime_error for what is no ready file. An empty path names none.
void remove_stale_ready_file(const std::string& path);

class ReadyFile {
 public:
  // Writes it; takes the place of a live server's. Throws std::runtime_error for a file that is not one of
  // ours, or when it can't be written.
  ReadyFile(const std::string& path, const std::vector<std::string>& addresses);
  ~ReadyFile();  // removes it, unless it is a successor's
  ReadyFile(const ReadyFile&) = delete;
  ReadyFile& operator=(const ReadyFile&) = delete;

 private:
  void write(const std::string& path, const std::string& text);

  int lock_;  // the file's descriptor, which has the lock
  UnlinkOnExit file_;
};

}  // namespace racebeam
