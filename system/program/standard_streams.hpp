// Standard input, output and error, by their numbers.
#pragma once

#include <cstddef>
#include <string_view>

namespace racebeam {

inline constexpr int kStandardInput = 0, kStandardOutput = 1, kStandardError = 2;

// Called at the start of the program. If one of the streams is closed, the next file or socket would get its
// number, and messages for the user would go there. So a null device takes its place, open in the wrong
// direction, so that uses fail. Bytes are not translated, so that lines end as the protocol says.
void prepare_standard_streams();

bool is_terminal(int stream);
int terminal_columns(int stream);  // its width; 80 if unknown; 0 if it is not a terminal

// A destination that a thread may write to without waiting.
enum class OutputKind {
  kFile,  // the system cannot tell whether it has room
  kSocket,
  kOther
};
OutputKind kind_of_output(int stream);
bool has_room(int stream);  // must not be called for a file

// Writes what there is room for. Returns the number of bytes; -1: failed. For a file, it may block for ever.
std::ptrdiff_t write_some(int stream, OutputKind kind, std::string_view bytes);
bool may_be_repeated(int error);  // whether the write failed only for lack of room, or because of a signal

}  // namespace racebeam
