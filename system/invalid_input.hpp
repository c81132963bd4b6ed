// An invalid input of the program: an option, a file, an image, a state, a value in a request.
#pragma once

#include <stdexcept>

namespace racebeam {

// what() is one sentence for the user or the client: what is wrong, and what is accepted. Any other
// exception, including std::invalid_argument itself, is a fault of the program.
class InvalidInput : public std::invalid_argument {
 public:
  using std::invalid_argument::invalid_argument;
};

// A word that is not accepted in its place, whatever its value: an unknown key, one without '=', or one given
// twice.
class InvalidArguments : public InvalidInput {
 public:
  using InvalidInput::InvalidInput;
};

}  // namespace racebeam
