// Reads from and writes to pipes, sockets and terminals without waiting. A call that returns -1 has failed,
// and errno has the reason: EAGAIN if it would have to wait, another one if the system cannot tell.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace racebeam {

std::ptrdiff_t read_without_waiting(int descriptor, std::span<char> space);
std::ptrdiff_t write_without_waiting(int descriptor, std::string_view bytes);  // it may write a part

// Makes a pipe large enough for a long reply, which would otherwise wait for its reader in between. Does not
// change anything else, nor a pipe that may not grow.
void make_room(int pipe);

}  // namespace racebeam
