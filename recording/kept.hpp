// Files and folders that are there whole or not at all: written under a temporary name, synced, renamed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace racebeam {

// What may be written, in all.
class DiskBudget {
 public:
  explicit DiskBudget(std::size_t bytes) : most_(bytes) {}
  void take(std::size_t bytes);  // throws std::runtime_error when nothing is left
  std::size_t taken() const { return taken_; }

 private:
  std::size_t most_, taken_ = 0;
};

// All throw std::runtime_error with a sentence when the disk refuses.
class KeptFile {
 public:
  KeptFile(std::string path, DiskBudget& budget);
  ~KeptFile();  // without keep(), nothing is left
  KeptFile(const KeptFile&) = delete;
  KeptFile& operator=(const KeptFile&) = delete;

  void write(std::span<const std::uint8_t> bytes);
  void write(std::string_view text);
  void overwrite(std::size_t place, std::span<const std::uint8_t> bytes);  // what was written already
  void keep();                                                             // refuses to replace what is there

 private:
  void flush();

  std::string path_, temporary_;
  DiskBudget& budget_;
  int descriptor_;
  std::string waiting_;  // to be written
};

class KeptFolder {
 public:
  KeptFolder(std::string path, DiskBudget& budget);
  ~KeptFolder();
  KeptFolder(const KeptFolder&) = delete;
  KeptFolder& operator=(const KeptFolder&) = delete;

  void add(const std::string& name, std::span<const std::uint8_t> bytes);  // a whole file
  void keep();

 private:
  std::string path_, temporary_;
  DiskBudget& budget_;
};

}  // namespace racebeam
