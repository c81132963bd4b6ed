// Files that the user names: an image, a game file, tokens, a configuration. Only regular files are read.
// Pipes, devices, sockets and directories are refused at once, because reading one might block or never end.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>

#include "system/invalid_input.hpp"

namespace racebeam {

// The message is "WHAT PATH: REASON", such as "image pong.bin: there is no such file".
class InputFileError : public InvalidInput {
 public:
  using InvalidInput::InvalidInput;
};

// Opens a file for reading. The caller closes the descriptor. `what` begins the message of an error. Throws
// InputFileError.
int open_input_file(const std::string& what, const std::string& path);

// Returns the whole contents. Throws InputFileError, also if there are more than `most` bytes.
std::string read_input_file(const std::string& what, const std::string& path, std::size_t most);

}  // namespace racebeam
