// Files that the user names: an image, a game file, tokens, a configuration. Only a regular file is read.
// Pipes, devices, sockets and directories are refused at once: reading one may wait for ever, or never end.
#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>

#include "system/invalid_input.hpp"

namespace racebeam {

// The sentence is "WHAT PATH: REASON", such as "image pong.bin: there is no such file".
class InputFileError : public InvalidInput {
 public:
  using InvalidInput::InvalidInput;
};

// Open for reading; the caller closes the descriptor. `what` begins the sentence of an error. Throws
// InputFileError.
int open_input_file(const std::string& what, const std::string& path);

// The whole contents. Throws InputFileError, also for more than `most` bytes.
std::string read_input_file(const std::string& what, const std::string& path, std::size_t most);

}  // namespace racebeam
