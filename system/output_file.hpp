// Files and folders that the program creates, as file descriptors of the C library. A function that fails
// returns false, or -1 for a number, and leaves the reason in errno.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace racebeam {

// Who may read a file beside its owner. On Windows, the folder determines that.
enum class Readers { kNobody, kEveryone };

// Both make and open a file. They fail if something of its name exists.
int make_file(const std::string& path);
int make_temporary_file(std::string& name);  // replaces XXXXXX at the end of the name; its owner can read it

// Makes a file that is marked until unmark(). A marked file that a process has left behind is replaced.
int make_marked_file(const std::string& path);
void unmark(int file);

int open_to_append(const std::string& path);  // also to read; makes the file, and follows no link
int open_own_file(const std::string& path);   // to read; follows no link

bool set_readers(int file, Readers readers);
bool write_at(int file, std::size_t place, std::string_view bytes);  // all bytes
bool append(int file, std::string_view bytes);                       // if it fails, it may have written some
std::int64_t size_of_file(int file);
bool cut_file(int file, std::size_t size);  // truncates it to this size
bool sync_file(int file);                   // waits until its bytes are on the disk
bool sync_disk_of(int file);                // waits until all that was written to its disk is there
bool sync_disk_of(const std::string& path);

bool make_folder(const std::string& path);
bool make_temporary_folder(std::string& name);  // see make_temporary_file()
void open_folder_to_all(const std::string& path);
bool remove_folder(const std::string& path);  // it must be empty

bool rename_anew(const std::string& from, const std::string& to);  // fails if `to` exists; syncs the folder
bool rename_over(const std::string& from, const std::string& to);
bool remove_file(const std::string& path);

// The identity of a file, which distinguishes it from another file that has replaced it.
struct FileMark {
  std::uint64_t number = 0;  // of the file in its file system; 0 if the file does not exist
  std::int64_t seconds = 0, nanoseconds = 0;
  bool is_regular = false;
  bool operator==(const FileMark&) const = default;
};
FileMark mark_of(const std::string& path);  // follows no link

bool all_may_read(const std::string& path);  // whether every user of this machine may

}  // namespace racebeam
