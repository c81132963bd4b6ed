// Publishes the server's addresses: a file with one address a line, which appears as a whole. Its first line
// identifies it; a file without that line is never changed. The server holds a lock (flock) on its file
// during its lifetime. So the file of a server that died can be told from that of a live one.
#pragma once

#include <string>
#include <vector>

#include "server/operation/unlink_on_exit.hpp"

namespace racebeam {

// Removes the file of a server that died, so that clients do not find its addresses. The file of a live
// server is not changed. Throws std::runtime_error if the file is not a ready file. Does nothing for an empty
// path.
void remove_stale_ready_file(const std::string& path);

class ReadyFile {
 public:
  // Writes the file, and replaces that of a live server. Throws std::runtime_error if the file is not a ready
  // file, or cannot be written.
  ReadyFile(const std::string& path, const std::vector<std::string>& addresses);
  ~ReadyFile();  // removes it, unless it is another server's
  ReadyFile(const ReadyFile&) = delete;
  ReadyFile& operator=(const ReadyFile&) = delete;

 private:
  void write(const std::string& path, const std::string& text);

  int lock_;  // the file's descriptor, which has the lock
  UnlinkOnExit file_;
};

}  // namespace racebeam
