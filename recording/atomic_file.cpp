#include "recording/atomic_file.hpp"

#include <fcntl.h>
#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <system_error>

namespace racebeam {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& what, const std::string& path) {
  const std::string reason = std::generic_category().message(errno);
  throw std::runtime_error("cannot " + what + " " + fs::path(path).filename().string() + ": " + reason);
}

// Hidden, and in the same folder, so that it can be renamed.
std::string temporary_name(const std::string& path) {
  const fs::path whole(path);
  std::string name = ".";
  (name += whole.filename().string()) += ".XXXXXX";
  return (whole.parent_path() / name).string();
}

void write_all(int descriptor, std::size_t place, std::string_view bytes, const std::string& path) {
  while (!bytes.empty()) {
    const ssize_t written = ::pwrite(descriptor, bytes.data(), bytes.size(), static_cast<off_t>(place));
    if (written < 0 && errno != EINTR) fail("write", path);
    if (written <= 0) continue;
    bytes.remove_prefix(static_cast<std::size_t>(written));
    place += static_cast<std::size_t>(written);
  }
}

void sync_folder_of(const std::string& path) {
  const int folder = ::open(fs::path(path).parent_path().c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return;
  ::fsync(folder);
  ::close(folder);
}

// Renames a file unless `path` exists.
bool renames_anew(const char* temporary, const char* path) {
#if defined(RENAME_NOREPLACE)
  return ::renameat2(AT_FDCWD, temporary, AT_FDCWD, path, RENAME_NOREPLACE) == 0;
#else
  return ::link(temporary, path) == 0 && ::unlink(temporary) == 0;
#endif
}

void rename_anew(const std::string& temporary, const std::string& path) {
  if (!renames_anew(temporary.c_str(), path.c_str())) fail("create", path);
  sync_folder_of(path);
}

void refuse_existing(const std::string& path) {
  if (fs::symlink_status(path).type() == fs::file_type::not_found) return;  // a broken link exists, too
  throw std::runtime_error(fs::path(path).filename().string() + " exists; choose another name");
}

std::string_view text_of(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// The sticky bit, which means nothing to a file, marks one that is written aside.
constexpr mode_t kAside = S_ISVTX | 0644;

// Whether a kill left the file behind when replace_file() wrote it.
bool is_left_behind(const std::string& name) {
  struct stat facts {};
  return ::lstat(name.c_str(), &facts) == 0 && S_ISREG(facts.st_mode) && (facts.st_mode & S_ISVTX) != 0 &&
         facts.st_uid == ::geteuid();
}

// A new file beside `path`: .NAME.part, or .NAME.part1 and so on if another program has a file of that name.
// What a kill left behind is replaced. The file is removed unless it is renamed.
class Aside {
 public:
  explicit Aside(const std::string& path) {
    const fs::path whole(path);
    const std::string hidden = std::string(".").append(whole.filename().string()).append(".part");
    const std::string first = (whole.parent_path() / hidden).string();
    for (int number = 0; descriptor_ < 0 && number < kMostNames; ++number) {
      name_ = number == 0 ? first : first + std::to_string(number);
      if (is_left_behind(name_)) ::unlink(name_.c_str());
      descriptor_ = ::open(name_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, kAside);
      if (descriptor_ < 0 && errno != EEXIST) break;
    }
    if (descriptor_ < 0) fail("make", path);
  }
  ~Aside() {
    ::close(descriptor_);
    if (!name_.empty()) ::unlink(name_.c_str());
  }
  Aside(const Aside&) = delete;
  Aside& operator=(const Aside&) = delete;

  int descriptor() const { return descriptor_; }

  void rename_to(const std::string& path) {
    if (::rename(name_.c_str(), path.c_str()) != 0) fail("replace", path);
    name_.clear();
    struct stat facts {};
    if (::fstat(descriptor_, &facts) == 0) ::fchmod(descriptor_, facts.st_mode & 0777);
  }

 private:
  static constexpr int kMostNames = 100;

  std::string name_;  // empty: renamed
  int descriptor_ = -1;
};

// The file that a symbolic link names, be it there or not.
std::string target_of(std::string path) {
  constexpr int kMostLinks = 40;
  std::error_code none;
  for (int links = 0; links < kMostLinks && fs::is_symlink(path, none); ++links)
    path = (fs::path(path).parent_path() / fs::read_symlink(path)).string();
  return path;
}

}  // namespace

void DiskBudget::take(std::size_t bytes) {
  if (bytes > most_ - taken_)
    throw BudgetSpent("the recording has reached its limit of " + std::to_string(most_) + " bytes");
  taken_ += bytes;
}

AtomicFile::AtomicFile(std::string path, DiskBudget& budget, std::string tail)
    : path_(std::move(path)), temporary_(temporary_name(path_)), budget_(budget), tail_(std::move(tail)) {
  refuse_existing(path_);
  budget_.take(tail_.size());
  descriptor_ = ::mkostemp(temporary_.data(), O_CLOEXEC);
  if (descriptor_ < 0) fail("make", path_);
  ::fchmod(descriptor_, 0644);
}

AtomicFile::~AtomicFile() {
  if (descriptor_ < 0) return;
  ::close(descriptor_);
  ::unlink(temporary_.c_str());
}

void AtomicFile::write(std::span<const std::uint8_t> bytes) { write(text_of(bytes)); }

void AtomicFile::write(std::string_view text) {
  budget_.take(text.size());
  try {
    write_all(descriptor_, size_ + text.size(), tail_, path_);
    write_all(descriptor_, size_, text, path_);
  } catch (...) {
    budget_.give_back(text.size());
    throw;
  }
  size_ += text.size();
}

void AtomicFile::overwrite(std::size_t place, std::span<const std::uint8_t> bytes) {
  write_all(descriptor_, place, text_of(bytes), path_);
}

void AtomicFile::count_growth() {
  struct stat facts {};
  if (::fstat(descriptor_, &facts) != 0) fail("read", path_);
  const auto size = static_cast<std::size_t>(facts.st_size);
  if (size <= size_) return;
  budget_.take(size - size_);
  size_ = size;
}

// Removes data that was written in part. The tail already had its space on the disk, so writing it needs no
// more.
void AtomicFile::commit() {
  write_all(descriptor_, size_, tail_, path_);
  if (::ftruncate(descriptor_, static_cast<off_t>(size_ + tail_.size())) != 0) fail("write", path_);
  if (::fsync(descriptor_) != 0) fail("sync", path_);
  rename_anew(temporary_, path_);
  ::close(descriptor_);
  descriptor_ = -1;
}

void replace_file(const std::string& path, std::string_view bytes, Durable durable) {
  const std::string target = target_of(path);
  Aside aside(target);
  write_all(aside.descriptor(), 0, bytes, path);
  if (durable == Durable::kNow && ::syncfs(aside.descriptor()) != 0) fail("sync", path);
  aside.rename_to(target);
}

AtomicFolder::AtomicFolder(std::string path, DiskBudget& budget)
    : path_(std::move(path)), temporary_(temporary_name(path_)), budget_(budget) {
  refuse_existing(path_);
  if (::mkdtemp(temporary_.data()) == nullptr) fail("make", path_);
}

AtomicFolder::~AtomicFolder() {
  if (temporary_.empty()) return;
  std::error_code ignored;
  fs::remove_all(temporary_, ignored);
}

void AtomicFolder::add(const std::string& name, std::span<const std::uint8_t> bytes) {
  budget_.take(bytes.size());
  const std::string file = temporary_ + "/" + name;
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
  try {
    if (descriptor < 0) fail("make", file);
    write_all(descriptor, 0, text_of(bytes), file);
  } catch (...) {
    budget_.give_back(bytes.size());
    if (descriptor < 0) throw;  // a file of that name may be there, and stays
    ::close(descriptor);
    ::unlink(file.c_str());
    throw;
  }
  ::close(descriptor);
}

// One sync for all files: one for each file would stall the session.
void AtomicFolder::commit() {
  const int folder = ::open(temporary_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) fail("open", path_);
  const bool synced = ::syncfs(folder) == 0;
  ::close(folder);
  if (!synced) fail("sync", path_);
  fs::permissions(temporary_, fs::perms(0755));
  rename_anew(temporary_, path_);
  temporary_.clear();
}

}  // namespace racebeam
