#include "system/program/standard_streams.hpp"

#include <windows.h>

#include <fcntl.h>
#include <io.h>

#include <array>
#include <cerrno>

#include "system/windows/files.hpp"

namespace racebeam {

void prepare_standard_streams() {
  constexpr std::array kWays = {_O_WRONLY, _O_RDONLY, _O_RDONLY};
  for (int stream = 0; stream < 3; ++stream) {
    if (_get_osfhandle(stream) < 0) _open("NUL", kWays.at(static_cast<std::size_t>(stream)) | _O_BINARY);
    _setmode(stream, _O_BINARY);
  }
  SetConsoleOutputCP(CP_UTF8);
}

// The C library takes any device, such as NUL, for a terminal.
bool is_terminal(int stream) {
  DWORD mode = 0;
  return GetConsoleMode(handle_of(stream), &mode) != 0;
}

int terminal_columns(int stream) {
  constexpr int kUsual = 80;
  if (!is_terminal(stream)) return 0;
  CONSOLE_SCREEN_BUFFER_INFO screen{};
  if (GetConsoleScreenBufferInfo(handle_of(stream), &screen) == 0) return kUsual;
  return screen.srWindow.Right - screen.srWindow.Left + 1;
}

// The system does not tell whether there is room, so each output is written like a file.
OutputKind kind_of_output(int) { return OutputKind::kFile; }
bool has_room(int) { return true; }

std::ptrdiff_t write_some(int stream, OutputKind, std::string_view bytes) {
  DWORD count = 0;
  if (WriteFile(handle_of(stream), bytes.data(), static_cast<DWORD>(bytes.size()), &count, nullptr) != 0)
    return static_cast<std::ptrdiff_t>(count);
  errno = reason_of(GetLastError());
  return -1;
}

bool may_be_repeated(int) { return false; }

}  // namespace racebeam
