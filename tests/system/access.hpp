// Asks the system about the access to memory. A test that tried it would end.
#pragma once

#if defined(_WIN32)
#include <windows.h>
#else
#include <unistd.h>

#include <array>
#include <catch2/catch.hpp>
#include <cerrno>
#endif

#include <cstddef>

namespace racebeam::test {

#if defined(_WIN32)

inline DWORD protection_of(const std::byte* byte) {
  MEMORY_BASIC_INFORMATION page{};
  VirtualQuery(byte, &page, sizeof page);
  return page.State == MEM_COMMIT ? page.Protect : PAGE_NOACCESS;
}

inline bool readable(const std::byte* byte) { return protection_of(byte) != PAGE_NOACCESS; }
inline bool writable(std::byte* byte) { return protection_of(byte) == PAGE_READWRITE; }

#else

// Whether `transfer` moves a byte through a pipe that has one already if it is `filled`.
template <class Transfer>
bool transfers(bool filled, const Transfer& transfer) {
  std::array<int, 2> ends{};
  REQUIRE(::pipe(ends.data()) == 0);
  if (filled) REQUIRE(::write(ends[1], "x", 1) == 1);
  const bool fine = transfer(ends) == 1;
  const int error = errno;
  for (const int end : ends) ::close(end);
  REQUIRE((fine || error == EFAULT));
  return fine;
}

inline bool readable(const std::byte* byte) {
  return transfers(false, [byte](const std::array<int, 2>& ends) { return ::write(ends[1], byte, 1); });
}

inline bool writable(std::byte* byte) {
  return transfers(true, [byte](const std::array<int, 2>& ends) { return ::read(ends[0], byte, 1); });
}

#endif

}  // namespace racebeam::test
