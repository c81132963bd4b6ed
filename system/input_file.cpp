#include "system/input_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>

namespace racebeam {
namespace {

// A file that the user named, and what it is for.
struct Named {
  const std::string& what;
  const std::string& path;

  [[noreturn]] void refuse(const std::string& reason) const {
    throw InputFileError(what + " " + path + ": " + reason);
  }
  [[noreturn]] void fail() const {
    if (errno == ENOENT) refuse("no such file");
    refuse("the file cannot be read: " + std::generic_category().message(errno));
  }
};

struct Kind {
  mode_t mode;
  const char* name;
};
constexpr std::array kKinds = {Kind{S_IFDIR, "a directory"}, Kind{S_IFIFO, "a pipe"},
                               Kind{S_IFSOCK, "a socket"}, Kind{S_IFCHR, "a device"},
                               Kind{S_IFBLK, "a device"}};

void check_kind(const Named& named, const struct stat& found) {
  for (const Kind& kind : kKinds) {
    if ((found.st_mode & S_IFMT) == kind.mode)
      named.refuse("this is " + std::string(kind.name) + ", not a file");
  }
}

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int get() const { return number_; }
  int release() {
    const int number = number_;
    number_ = -1;
    return number;
  }

 private:
  int number_;
};

}  // namespace

// Opening a device may have an effect, so the file's kind is checked before. The name may be changed
// meanwhile, so the file is opened without blocking, and checked again.
int open_input_file(const std::string& what, const std::string& path) {
  const Named named{what, path};
  struct stat found {};
  if (::stat(path.c_str(), &found) != 0) named.fail();
  check_kind(named, found);
  Descriptor file(::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC));
  if (file.get() < 0 || ::fstat(file.get(), &found) != 0) named.fail();
  check_kind(named, found);
  return file.release();
}

void each_piece(const std::string& what, const std::string& path,
                const std::function<void(std::string_view)>& visit) {
  const Descriptor file(open_input_file(what, path));
  std::array<char, 1 << 16> piece;
  for (;;) {
    const ssize_t count = ::read(file.get(), piece.data(), piece.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) Named{what, path}.fail();
    if (count == 0) return;
    visit({piece.data(), static_cast<std::size_t>(count)});
  }
}

// The size that the system reports is not used: files of /proc report none.
std::string read_input_file(const std::string& what, const std::string& path, std::size_t most) {
  std::string text;
  each_piece(what, path, [&](std::string_view piece) {
    if (piece.size() > most - text.size())
      Named{what, path}.refuse("larger than " + std::to_string(most) + " bytes");
    text += piece;
  });
  return text;
}

void each_line(const std::string& what, const std::string& path, std::size_t most,
               const std::function<void(std::string_view, bool)>& visit) {
  std::string line;  // what has been read of one that began in an earlier piece
  std::size_t number = 1;
  each_piece(what, path, [&](std::string_view piece) {
    for (std::size_t end; !piece.empty(); piece.remove_prefix(end)) {
      end = std::min(piece.find('\n'), piece.size());
      if (line.size() + end > most)
        Named{what, path}.refuse("line " + std::to_string(number) + " has more than " + std::to_string(most) +
                                 " bytes");
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
