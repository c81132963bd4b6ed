// The file functions that differ between Linux and macOS, for output_file.cpp.
#pragma once

#include <sys/stat.h>
#include <time.h>

namespace racebeam {

// A mark of a file, which other programs ignore.
extern const mode_t kModeOfMarked;  // the mode with which a marked file is made
void mark(int file);                // marks a file that was made with that mode
void unmark(int file, const struct stat& facts);
bool is_marked(const struct stat& facts);

timespec changed_at(const struct stat& facts);

bool sync_bytes(int file);  // `file` may be a folder
bool sync_disk(int file);   // the whole disk

bool rename_if_new(const char* from, const char* to);  // fails if `to` exists

}  // namespace racebeam
