// A folder for the files of one process. Not available on Windows.
#pragma once

#include <filesystem>

namespace racebeam {

// A new folder that only this user can read. The process that has made it removes it, with what is in it. If
// that process is killed, its child does.
class PrivateFolder {
 public:
  PrivateFolder();  // in TMPDIR, else /tmp; throws std::runtime_error
  ~PrivateFolder();
  PrivateFolder(const PrivateFolder&) = delete;
  PrivateFolder& operator=(const PrivateFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  int owner_;
};

}  // namespace racebeam
