// Regular files, open for reading, as the numbers that the C library has for open files.
#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace racebeam {

struct OpenedFile {
  int descriptor = -1;  // the caller closes it
  std::string refusal;  // the reason, if the file is not open: "no such file"
};

// Opens a file without waiting. Refuses anything but a regular file, without an effect on it.
OpenedFile open_regular_file(const std::string& path);

// Reads at most as many bytes as fit. Returns how many; 0: the file ends; -1: failed, and errno has the
// reason.
std::ptrdiff_t read_from(int descriptor, std::span<char> bytes);

int duplicate_descriptor(int descriptor);  // returns -1 if it fails, and errno has the reason
void close_file(int descriptor);

// Returns "the file cannot be read", with the reason that errno has.
std::string read_refusal(int error);

}  // namespace racebeam
