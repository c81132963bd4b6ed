// What Wine lacks of Windows, which tests leave out there.
#pragma once

#if defined(_WIN32)
#include <windows.h>
#endif

namespace racebeam::test {

// Whether Wine runs this program.
inline bool in_wine() {
#if defined(_WIN32)
  return GetProcAddress(GetModuleHandleA("ntdll.dll"), "wine_get_version") != nullptr;
#else
  return false;
#endif
}

}  // namespace racebeam::test
