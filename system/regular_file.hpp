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

// Opens a file without waiting. Anything but a regular file is refused, and opening it has no effect.
OpenedFile open_regular_file(const std::string& path);

// Reads at most so many bytes. Returns how many; 0: the file ends; -1: failed, and errno has the reason.
std::ptrdiff_t read_from(int descriptor, std::span<char> bytes);

int another_number(int descriptor);  // of the same open file; -1: failed, and errno has the reason
void close_file(int descriptor);

// "the file cannot be read", and why.
std::string read_refusal(int error);

}  // namespace racebeam
