// Files and folders that are there whole or not at all: written under a temporary name, synced, renamed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

namespace racebeam {

class BudgetSpent : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// What may be written, in all.
class DiskBudget {
 public:
  explicit DiskBudget(std::size_t bytes) : most_(bytes) {}
  void take(std::size_t bytes);  // throws BudgetSpent when so much is not left
  void give_back(std::size_t bytes) { taken_ -= bytes; }
  std::size_t taken() const { return taken_; }

 private:
  std::size_t most_, taken_ = 0;
};

// All throw std::runtime_error with a sentence when the disk refuses, or BudgetSpent.
class KeptFile {
 public:
  // `tail`: what the file ends with, whatever is written. It is there from the start, so that no disk is too
  // full for it at the end.
  KeptFile(std::string path, DiskBudget& budget, std::string tail = {});
  ~KeptFile();  // without keep(), nothing is left
  KeptFile(const KeptFile&) = delete;
  KeptFile& operator=(const KeptFile&) = delete;

  // Appends all of it; when it throws, what is kept has nothing of it.
  void write(std::span<const std::uint8_t> bytes);
  void write(std::string_view text);
  void overwrite(std::size_t place, std::span<const std::uint8_t> bytes);  // what was written already
  void keep();                                                             // refuses to replace what is there

 private:
  std::string path_, temporary_;
  DiskBudget& budget_;
  const std::string tail_;
  int descriptor_ = -1;
  std::size_t size_ = 0;  // without the tail
};

class KeptFolder {
 public:
  KeptFolder(std::string path, DiskBudget& budget);
  ~KeptFolder();
  KeptFolder(const KeptFolder&) = delete;
  KeptFolder& operator=(const KeptFolder&) = delete;

  void add(const std::string& name, std::span<const std::uint8_t> bytes);  // a whole file, or none
  void keep();

 private:
  std::string path_, temporary_;
  DiskBudget& budget_;
};

}  // namespace racebeam
