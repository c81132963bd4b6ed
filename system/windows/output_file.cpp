#include "system/output_file.hpp"

#include <windows.h>

#include <fcntl.h>
#include <io.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>

#include "system/entropy.hpp"
#include "system/windows/files.hpp"

namespace racebeam {
namespace {

// Other processes may open, rename and remove an open file, as on other systems.
constexpr DWORD kShared = FILE_SHARE_READ | FILE_SHARE_WRITE | FILE_SHARE_DELETE;
constexpr DWORD kMark = FILE_ATTRIBUTE_TEMPORARY;  // also keeps small files, such as these, in memory
constexpr int kTries = 100;
constexpr DWORD kPause = 10;  // milliseconds between tries to replace a file

bool did(BOOL succeeded) {
  if (succeeded == 0) errno = reason_of(GetLastError());
  return succeeded != 0;
}

int open(const std::string& path, DWORD access, DWORD how, DWORD attributes, int flags) {
  const HANDLE handle =
      CreateFileW(name_of(path).c_str(), access, kShared, nullptr, how, attributes, nullptr);
  if (!did(handle != INVALID_HANDLE_VALUE)) return -1;
  const int file = _open_osfhandle(reinterpret_cast<intptr_t>(handle), flags | _O_BINARY | _O_NOINHERIT);
  if (file < 0) CloseHandle(handle);
  return file;
}

int make(const std::string& path, DWORD attributes) {
  return open(path, GENERIC_READ | GENERIC_WRITE, CREATE_NEW, attributes, _O_RDWR);
}

// Calls make() with names that end in random letters until one is new.
template <typename Make>
bool make_of_random_name(std::string& name, Make make) {
  constexpr std::string_view kLetters = "abcdefghijklmnopqrstuvwxyz012345";
  constexpr std::size_t kRandom = 6;
  for (int tries = 0; tries < kTries; ++tries) {
    std::size_t number = random_number();
    std::generate(name.end() - kRandom, name.end(), [&] {
      const char letter = kLetters[number % kLetters.size()];
      number /= kLetters.size();
      return letter;
    });
    if (make(name)) return true;
    if (errno != EEXIST) return false;
  }
  return false;
}

bool rename(const std::string& from, const std::string& to, DWORD how) {
  return did(MoveFileExW(name_of(from).c_str(), name_of(to).c_str(), how | MOVEFILE_WRITE_THROUGH));
}

}  // namespace

int make_file(const std::string& path) { return make(path, FILE_ATTRIBUTE_NORMAL); }

int make_temporary_file(std::string& name) {
  int file = -1;
  make_of_random_name(name, [&](const std::string& path) { return (file = make_file(path)) >= 0; });
  return file;
}

int make_marked_file(const std::string& path) {
  const DWORD found = GetFileAttributesW(name_of(path).c_str());
  if (found != INVALID_FILE_ATTRIBUTES && (found & kMark) != 0) remove_file(path);
  return make(path, kMark);
}

void unmark(int file) {
  FILE_BASIC_INFO facts{};
  facts.FileAttributes = FILE_ATTRIBUTE_NORMAL;
  SetFileInformationByHandle(handle_of(file), FileBasicInfo, &facts, sizeof facts);
}

int open_to_append(const std::string& path) {
  return open(path, GENERIC_READ | GENERIC_WRITE, OPEN_ALWAYS,
              FILE_ATTRIBUTE_NORMAL | FILE_FLAG_OPEN_REPARSE_POINT, _O_RDWR | _O_APPEND);
}

int open_own_file(const std::string& path) {
  return open(path, GENERIC_READ, OPEN_EXISTING, FILE_FLAG_OPEN_REPARSE_POINT, _O_RDONLY);
}

bool set_readers(int, Readers) { return true; }

// Writes at `place`, wherever the last bytes were written.
bool write_at(int file, std::size_t place, std::string_view bytes) {
  while (!bytes.empty()) {
    OVERLAPPED at{};
    at.Offset = static_cast<DWORD>(place);
    at.OffsetHigh = static_cast<DWORD>(std::uint64_t{place} >> 32);
    const auto size = static_cast<DWORD>(std::min<std::size_t>(bytes.size(), 1 << 30));
    DWORD written = 0;
    if (!did(WriteFile(handle_of(file), bytes.data(), size, &written, &at))) return false;
    bytes.remove_prefix(written);
    place += written;
  }
  return true;
}

bool append(int file, std::string_view bytes) {
  const std::int64_t size = size_of_file(file);
  return size >= 0 && write_at(file, static_cast<std::size_t>(size), bytes);
}

std::int64_t size_of_file(int file) {
  LARGE_INTEGER size{};
  return did(GetFileSizeEx(handle_of(file), &size)) ? size.QuadPart : -1;
}

bool cut_file(int file, std::size_t size) {
  FILE_END_OF_FILE_INFO end{};
  end.EndOfFile.QuadPart = static_cast<LONGLONG>(size);
  return did(SetFileInformationByHandle(handle_of(file), FileEndOfFileInfo, &end, sizeof end));
}

bool sync_file(int file) { return did(FlushFileBuffers(handle_of(file))); }

// Only an administrator may sync a whole disk.
bool sync_disk_of(int file) { return sync_file(file); }
bool sync_disk_of(const std::string& path) {
  return did(GetFileAttributesW(name_of(path).c_str()) != INVALID_FILE_ATTRIBUTES);
}

bool make_folder(const std::string& path) { return did(CreateDirectoryW(name_of(path).c_str(), nullptr)); }
bool make_temporary_folder(std::string& name) { return make_of_random_name(name, make_folder); }
void open_folder_to_all(const std::string&) {}
bool remove_folder(const std::string& path) { return did(RemoveDirectoryW(name_of(path).c_str())); }

bool rename_anew(const std::string& from, const std::string& to) { return rename(from, to, 0); }

// The system does not replace a file that a reader has open. This tries again, since a reader soon closes it.
bool rename_over(const std::string& from, const std::string& to) {
  for (int tries = 1; !rename(from, to, MOVEFILE_REPLACE_EXISTING); ++tries) {
    if (errno != EACCES || tries == kTries) return false;
    Sleep(kPause);
  }
  return true;
}

bool remove_file(const std::string& path) { return did(DeleteFileW(name_of(path).c_str())); }

FileMark mark_of(const std::string& path) {
  const HANDLE file =
      CreateFileW(name_of(path).c_str(), FILE_READ_ATTRIBUTES, kShared, nullptr, OPEN_EXISTING,
                  FILE_FLAG_OPEN_REPARSE_POINT | FILE_FLAG_BACKUP_SEMANTICS, nullptr);
  if (file == INVALID_HANDLE_VALUE) return {};
  BY_HANDLE_FILE_INFORMATION facts{};
  const bool found = GetFileInformationByHandle(file, &facts) != 0;
  CloseHandle(file);
  if (!found) return {};
  const auto both = [](DWORD high, DWORD low) { return std::uint64_t{high} << 32 | low; };
  constexpr DWORD kOthers = FILE_ATTRIBUTE_DIRECTORY | FILE_ATTRIBUTE_REPARSE_POINT | FILE_ATTRIBUTE_DEVICE;
  const FILETIME& time = facts.ftCreationTime;
  return {both(facts.nFileIndexHigh, facts.nFileIndexLow),
          static_cast<std::int64_t>(both(time.dwHighDateTime, time.dwLowDateTime)), 0,
          (facts.dwFileAttributes & kOthers) == 0};
}

bool all_may_read(const std::string&) { return false; }  // only the user can read their folders

}  // namespace racebeam
