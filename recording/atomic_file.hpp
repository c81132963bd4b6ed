// Files and folders that appear whole or not at all: written under a temporary name, synced, renamed.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

namespace racebeam {

class BudgetSpent : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// How many bytes a file of many is charged for in addition to its own: a block of the disk, and its place in
// the folder. So a budget also limits the number of files.
constexpr std::size_t kBytesBesideFile = 4096;

// Limits the bytes that may be written in total.
class DiskBudget {
 public:
  using Flag = std::shared_ptr<const std::atomic<bool>>;

  // Another thread sets `given_up` when nothing needs to be written any more.
  explicit DiskBudget(std::size_t bytes, Flag given_up = nullptr)
      : most_(bytes), given_up_(std::move(given_up)) {}
  void take(std::size_t bytes);  // throws BudgetSpent if less is left
  void give_back(std::size_t bytes) { taken_ -= bytes; }
  std::size_t taken() const { return taken_; }
  bool is_given_up() const { return given_up_ && *given_up_; }

 private:
  std::size_t most_, taken_ = 0;
  Flag given_up_;
};

// All members throw BudgetSpent, or std::runtime_error with a sentence if the system refuses to write.
class AtomicFile {
 public:
  // tail: the end of the file, which follows everything that is written. Its space is reserved at the start,
  // so that a full disk cannot prevent the end.
  AtomicFile(std::string path, DiskBudget& budget, std::string tail = {});
  ~AtomicFile();  // removes the file, unless commit() was called
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  // Appends all bytes. If it throws, the file is as it was.
  void write(std::span<const std::uint8_t> bytes);
  void write(std::string_view text);
  void overwrite(std::size_t place, std::span<const std::uint8_t> bytes);  // bytes that were written before
  // Refuses to replace an existing file, and to keep what another program has put in place of this one.
  void commit();

  // For another program that writes the file instead: the file's name until commit(), and a call that charges
  // the budget for the bytes that the file has gained.
  const std::string& temporary() const { return temporary_; }
  void count_growth();

 private:
  void check_place() const;  // whether the temporary name is still that of this file

  std::string path_, temporary_;
  DiskBudget& budget_;
  const std::string tail_;
  int descriptor_ = -1;
  std::uint64_t number_ = 0;  // of the file in its file system
  std::size_t size_ = 0;      // without the tail
};

// Whether replace_file() waits for the disk.
enum class Durable {
  kLater,  // after a kill, there is the old file or the new one; after a power cut, perhaps neither
  kNow     // the new file appears only after everything written to its disk before is there
};

// Writes a whole file aside, under the name .NAME.part if no other program has a file of that name. Renames
// it over the file at `path`, or over the file that `path` links to. Only one thread may call it at a time.
// Throws std::runtime_error with the path; the file is then unchanged.
void replace_file(const std::string& path, std::string_view bytes, Durable durable);

class AtomicFolder {
 public:
  AtomicFolder(std::string path, DiskBudget& budget);
  ~AtomicFolder();
  AtomicFolder(const AtomicFolder&) = delete;
  AtomicFolder& operator=(const AtomicFolder&) = delete;

  // Writes the whole file, or none of it.
  void add(const std::string& name, std::span<const std::uint8_t> bytes);
  void commit();

 private:
  std::string path_, temporary_;
  DiskBudget& budget_;
};

}  // namespace racebeam
