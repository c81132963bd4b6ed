// Tells those who wait for a server where it listens: a file with an address a line, there whole or not at
// all.
#pragma once

#include <string>
#include <vector>

#include "server/own_file.hpp"

namespace racebeam {

class ReadyFile {
 public:
  // Removes what a server before has left: who waits for the file must not find that one's. Throws
  // std::runtime_error when it can't.
  explicit ReadyFile(std::string path);
  ~ReadyFile();  // removes it, unless it is a successor's: nobody listens any more
  ReadyFile(const ReadyFile&) = delete;
  ReadyFile& operator=(const ReadyFile&) = delete;

  void write(const std::vector<std::string>& addresses);  // throws std::runtime_error

 private:
  std::string path_;
  OwnFile file_;
};

}  // namespace racebeam
