// Reads from and writes to pipes, sockets and terminals that never wait. -1: failed, and errno has the
// reason: EAGAIN if the call would have to wait, another if the system cannot tell.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

namespace racebeam {

std::ptrdiff_t read_without_waiting(int descriptor, std::span<char> space);
std::ptrdiff_t write_without_waiting(int descriptor, std::string_view bytes);  // it may write a part

// Makes a pipe as large as a long reply, which would else wait for its reader in between. What is not a pipe,
// or may not be larger, stays as it is.
void make_room(int pipe);

}  // namespace racebeam
