#include "system/input_file.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>

#include "system/regular_file.hpp"

namespace racebeam {
namespace {

[[noreturn]] void refuse(const std::string& what, const std::string& path, const std::string& reason) {
  throw InputFileError(what + " " + path + ": " + reason);
}

struct Closed {
  ~Closed() { close_file(descriptor); }
  int descriptor;
};

}  // namespace

std::string read_refusal(int error) {
  if (error == ENOENT) return "no such file";
  return "the file cannot be read: " + std::generic_category().message(error);
}

int open_input_file(const std::string& what, const std::string& path) {
  const OpenedFile file = open_regular_file(path);
  if (file.descriptor < 0) refuse(what, path, file.refusal);
  return file.descriptor;
}

void each_piece(const std::string& what, const std::string& path,
                const std::function<void(std::string_view)>& visit) {
  const Closed file{open_input_file(what, path)};
  std::array<char, 1 << 16> piece;
  for (;;) {
    const std::ptrdiff_t count = read_from(file.descriptor, piece);
    if (count < 0) refuse(what, path, read_refusal(errno));
    if (count == 0) return;
    visit({piece.data(), static_cast<std::size_t>(count)});
  }
}

// Does not use the size that the system reports: it is 0 for files of /proc.
std::string read_input_file(const std::string& what, const std::string& path, std::size_t most) {
  std::string text;
  each_piece(what, path, [&](std::string_view piece) {
    if (piece.size() > most - text.size())
      refuse(what, path, "larger than " + std::to_string(most) + " bytes");
    text += piece;
  });
  return text;
}

void each_line(const std::string& what, const std::string& path, std::size_t most,
               const std::function<void(std::string_view, bool)>& visit) {
  std::string line;  // the beginning of a line from earlier pieces
  std::size_t number = 1;
  each_piece(what, path, [&](std::string_view piece) {
    for (std::size_t end; !piece.empty(); piece.remove_prefix(end)) {
      end = std::min(piece.find('\n'), piece.size());
      if (line.size() + end > most)
        refuse(what, path,
               "line " + std::to_string(number) + " has more than " + std::to_string(most) + " bytes");
      line += piece.substr(0, end);
      if (end == piece.size()) return;
      visit(line, true);
      line.clear();
      ++number;
      ++end;
    }
  });
  if (!line.empty()) visit(line, false);
}

}  // namespace racebeam
