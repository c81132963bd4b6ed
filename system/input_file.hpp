// Files that the user names: an image, a game file, tokens, a configuration. Only regular files are read.
// Pipes, devices, sockets and directories are refused at once, because reading one might block or never end.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

#include "system/invalid_input.hpp"

namespace racebeam {

// The message is "WHAT PATH: REASON", such as "image pong.bin: no such file".
class InputFileError : public InvalidInput {
 public:
  using InvalidInput::InvalidInput;
};

// Opens a file for reading. The caller closes the descriptor. `what` begins the message of an error. Throws
// InputFileError.
int open_input_file(const std::string& what, const std::string& path);

// Returns the whole contents. Throws InputFileError, also if there are more than `most` bytes.
std::string read_input_file(const std::string& what, const std::string& path, std::size_t most);

// Calls visit() with the contents, a piece of at most 64 KiB at a time. Throws InputFileError.
void each_piece(const std::string& what, const std::string& path,
                const std::function<void(std::string_view piece)>& visit);

// Calls visit() with each line, and with whether a newline ends it; only the last line may lack one. Throws
// InputFileError, also for a line of more than `most` bytes.
void each_line(const std::string& what, const std::string& path, std::size_t most,
               const std::function<void(std::string_view line, bool ends)>& visit);

}  // namespace racebeam
