// Publishes the addresses of a server in a file that appears as a whole. Its first bytes identify it; a file
// without them is never changed. The server holds a lock on its file during its lifetime, which distinguishes
// the file of a live server from that of a dead one.
#pragma once

#include <string>
#include <string_view>

#include "server/operation/unlink_on_exit.hpp"
#include "system/output_file.hpp"

namespace racebeam {

struct FileKind {
  std::string_view name, option;
  std::string_view mark;  // the first bytes of such a file
  Readers readers;
};

inline constexpr FileKind kReadyFile{
    "ready file", "--ready-file",
    "# racebeam ready file: the addresses of a server, one a line; lines that begin with # are comments\n",
    Readers::kEveryone};
inline constexpr FileKind kAnnounceFile{"announce file", "--announce",
                                        "{\"racebeam_announce\":", Readers::kNobody};

// Removes the file of a server that died, so that clients do not find its addresses. The file of a live
// server is not changed. Throws std::runtime_error if the file is not of this kind. Does nothing for an empty
// path.
void remove_stale(const FileKind& kind, const std::string& path);

class PublishedFile {
 public:
  // Writes the file. If it is the file of a live server, replaces it, with a warning in the log. `text`
  // begins with the mark. Throws std::runtime_error if the file is of another kind, or cannot be written; a
  // file written in part does not remain.
  PublishedFile(const FileKind& kind, const std::string& path, const std::string& text);
  ~PublishedFile();  // removes the file, unless another server has replaced it
  PublishedFile(const PublishedFile&) = delete;
  PublishedFile& operator=(const PublishedFile&) = delete;

 private:
  void write(const FileKind& kind, const std::string& path, const std::string& text);

  int lock_;  // the file's descriptor, which has the lock
  UnlinkOnExit file_;
};

}  // namespace racebeam
