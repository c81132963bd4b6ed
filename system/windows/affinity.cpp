#include "system/affinity.hpp"

#include <windows.h>

#include <string>
#include <system_error>

#include "system/invalid_input.hpp"

namespace racebeam {
namespace {

constexpr unsigned kMax = 8 * sizeof(DWORD_PTR);  // processors of a group; a process belongs to one group

}  // namespace

std::vector<unsigned> allowed_processors() {
  DWORD_PTR own = 0, all = 0;
  std::vector<unsigned> processors;
  if (GetProcessAffinityMask(GetCurrentProcess(), &own, &all) == 0) return processors;
  // A thread's mask can only be read by setting it.
  if (const DWORD_PTR thread = SetThreadAffinityMask(GetCurrentThread(), own); thread != 0) {
    SetThreadAffinityMask(GetCurrentThread(), thread);
    own = thread;
  }
  for (unsigned number = 0; number < kMax; ++number)
    if ((own >> number & 1) != 0) processors.push_back(number);
  return processors;
}

void bind_to(std::jthread& thread, unsigned processor) {
  const HANDLE handle = pthread_gethandle(thread.native_handle());
  if (processor < kMax && SetThreadAffinityMask(handle, DWORD_PTR{1} << processor) != 0) return;
  const int error = processor < kMax ? static_cast<int>(GetLastError()) : ERROR_INVALID_PARAMETER;
  throw InvalidInput("a thread could not be bound to processor " + std::to_string(processor) + ": " +
                     std::system_category().message(error));
}

}  // namespace racebeam
