#include "server/operation/published_file.hpp"

#include <cerrno>
#include <span>
#include <stdexcept>
#include <system_error>

#include "server/operation/log.hpp"
#include "system/file_lock.hpp"
#include "system/regular_file.hpp"

namespace racebeam {
namespace {

[[noreturn]] void fail(const FileKind& kind, const std::string& path) {
  throw std::runtime_error("cannot write the " + std::string(kind.name) + " " + path + ": " +
                           std::generic_category().message(errno));
}

std::string without_end(std::string_view line) { return std::string(line.substr(0, line.find('\n'))); }

[[noreturn]] void refuse_another(const FileKind& kind, const std::string& path) {
  throw std::runtime_error(std::string(kind.option) + " " + path + " exists, and is not " +
                           (kind.name.starts_with('a') ? "an " : "a ") + std::string(kind.name) +
                           ": it does not begin with '" + without_end(kind.mark) +
                           "'; choose another name, or remove it");
}

bool begins_with(const std::string_view mark, int file) {
  std::string text(mark.size(), '\0');
  std::span<char> rest(text);
  while (!rest.empty()) {
    const std::ptrdiff_t count = read_from(file, rest);
    if (count <= 0) return false;
    rest = rest.subspan(static_cast<std::size_t>(count));
  }
  return text == mark;
}

// Opens a file of this kind. Returns its descriptor, or -1 if it is missing. Opens only regular files, and
// follows no link.
int open_ours(const FileKind& kind, const std::string& path) {
  const FileMark found = mark_of(path);
  if (found.number == 0) return -1;  // other errors appear when the file is written
  if (!found.is_regular) refuse_another(kind, path);
  const int file = open_own_file(path);
  if (file < 0 && errno == ENOENT) return -1;
  if (file < 0) fail(kind, path);
  if (begins_with(kind.mark, file)) return file;
  close_file(file);
  refuse_another(kind, path);
}

}  // namespace

void remove_stale(const FileKind& kind, const std::string& path) {
  const int file = path.empty() ? -1 : open_ours(kind, path);
  if (file < 0) return;
  const bool removed = is_locked(file) || remove_file(path) || errno == ENOENT;
  close_file(file);
  if (!removed) fail(kind, path);
}

PublishedFile::PublishedFile(const FileKind& kind, const std::string& path, const std::string& text) {
  if (const int there = open_ours(kind, path); there >= 0) {
    if (is_locked(there))
      log_warning("the " + std::string(kind.name) + " " + path +
                  " of another server, which runs, is replaced");
    close_file(there);
  }
  write(kind, path, text);
}

PublishedFile::~PublishedFile() {
  file_.remove();
  close_file(lock_);
}

void PublishedFile::write(const FileKind& kind, const std::string& path, const std::string& text) {
  std::string temporary = path + ".XXXXXX";
  lock_ = make_temporary_file(temporary);
  if (lock_ < 0) fail(kind, path);
  lock_file(lock_, Waiting::kNo);  // if the file system does not have locks, the file counts as stale
  const bool written = write_at(lock_, 0, text) && set_readers(lock_, kind.readers) && sync_file(lock_);
  if (written && rename_over(temporary, path)) {
    file_ = UnlinkOnExit(path);
    return;
  }
  const int reason = errno;
  remove_file(temporary);
  close_file(lock_);
  errno = reason;
  fail(kind, path);
}

}  // namespace racebeam
