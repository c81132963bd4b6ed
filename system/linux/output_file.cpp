#include "system/output_file.hpp"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>

#include "system/linux/files.hpp"

namespace racebeam {
namespace {

namespace fs = std::filesystem;

bool is_left_behind(const std::string& name) {
  struct stat facts {};
  return ::lstat(name.c_str(), &facts) == 0 && S_ISREG(facts.st_mode) && is_marked(facts) &&
         facts.st_uid == ::geteuid();
}

int open_folder(const std::string& path) { return ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); }

void sync_folder_of(const std::string& path) {
  const int folder = open_folder(fs::path(path).parent_path().string());
  if (folder < 0) return;
  sync_bytes(folder);
  ::close(folder);
}

}  // namespace

int make_file(const std::string& path) {
  return ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
}

int make_temporary_file(std::string& name) { return ::mkostemp(name.data(), O_CLOEXEC); }

int make_marked_file(const std::string& path) {
  if (is_left_behind(path)) ::unlink(path.c_str());
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, kModeOfMarked);
  if (file >= 0) mark(file);
  return file;
}

void unmark(int file) {
  struct stat facts {};
  if (::fstat(file, &facts) == 0) unmark(file, facts);
}

int open_to_append(const std::string& path) {
  return ::open(path.c_str(), O_RDWR | O_APPEND | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0644);
}

int open_own_file(const std::string& path) {
  return ::open(path.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
}

bool set_readers(int file, Readers readers) {
  return ::fchmod(file, readers == Readers::kEveryone ? 0644 : 0600) == 0;
}

bool write_at(int file, std::size_t place, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::pwrite(file, bytes.data(), bytes.size(), static_cast<off_t>(place));
    if (written < 0 && errno != EINTR) return false;
    if (written <= 0) continue;
    bytes.remove_prefix(static_cast<std::size_t>(written));
    place += static_cast<std::size_t>(written);
  }
  return true;
}

bool append(int file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file, bytes.data(), bytes.size());
    if (written < 0 && errno != EINTR) return false;
    if (written > 0) bytes.remove_prefix(static_cast<std::size_t>(written));
  }
  return true;
}

std::int64_t size_of_file(int file) {
  struct stat facts {};
  return ::fstat(file, &facts) == 0 ? std::int64_t{facts.st_size} : -1;
}

bool cut_file(int file, std::size_t size) { return ::ftruncate(file, static_cast<off_t>(size)) == 0; }
bool sync_file(int file) { return sync_bytes(file); }
bool sync_disk_of(int file) { return sync_disk(file); }

bool sync_disk_of(const std::string& path) {
  const int folder = open_folder(path);
  if (folder < 0) return false;
  const bool synced = sync_disk_of(folder);
  ::close(folder);
  return synced;
}

bool make_folder(const std::string& path) { return ::mkdir(path.c_str(), 0755) == 0; }
bool make_temporary_folder(std::string& name) { return ::mkdtemp(name.data()) != nullptr; }
void open_folder_to_all(const std::string& path) { fs::permissions(path, fs::perms(0755)); }
bool remove_folder(const std::string& path) { return ::rmdir(path.c_str()) == 0; }

bool rename_anew(const std::string& from, const std::string& to) {
  if (!rename_if_new(from.c_str(), to.c_str())) return false;
  sync_folder_of(to);
  return true;
}

bool rename_over(const std::string& from, const std::string& to) {
  return ::rename(from.c_str(), to.c_str()) == 0;
}

bool remove_file(const std::string& path) { return ::unlink(path.c_str()) == 0; }

// The system may give the inode number of a removed file to the next one; the time then differs. The time of
// a pipe does not count, since it changes with each write.
FileMark mark_of(const std::string& path) {
  struct stat found {};
  if (::lstat(path.c_str(), &found) != 0) return {};
  if (S_ISFIFO(found.st_mode)) return {.number = found.st_ino};
  const timespec changed = changed_at(found);
  return {found.st_ino, changed.tv_sec, changed.tv_nsec, S_ISREG(found.st_mode)};
}

bool all_may_read(const std::string& path) {
  struct stat found {};
  return ::stat(path.c_str(), &found) == 0 && (found.st_mode & S_IROTH) != 0;
}

}  // namespace racebeam
