#include "system/input_file.hpp"

#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstring>
#include <filesystem>
#include <fstream>

namespace fs = std::filesystem;
using namespace racebeam;
using Catch::Matchers::Message;

namespace {

class Folder {
 public:
  Folder() { fs::create_directory(path_); }
  ~Folder() { fs::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  std::string operator/(const char* name) const { return path_ / name; }

 private:
  fs::path path_ = fs::temp_directory_path() / ("input-file-" + std::to_string(::getpid()));
};

void check_refused(const std::string& path, const std::string& reason) {
  CHECK_THROWS_MATCHES(read_input_file("image", path, 100), InputFileError,
                       Message("image " + path + ": " + reason));
}

}  // namespace

TEST_CASE("a file is read whole, up to the limit") {
  const Folder folder;
  const std::string path = folder / "file";
  for (const std::size_t size : {0, 1, 99, 100}) {
    std::ofstream(path) << std::string(size, 'x');
    CHECK(read_input_file("image", path, 100) == std::string(size, 'x'));
  }
  std::ofstream(path) << std::string(101, 'x');
  check_refused(path, "larger than 100 bytes");
}

TEST_CASE("lines are visited one by one, however long the file is") {
  const Folder folder;
  const std::string path = folder / "file";
  const std::string line(1000, 'x');
  {
    std::ofstream file(path);
    file << "\n";
    for (int number = 0; number < 1000; ++number) file << line << number << '\n';
    file << "end";
  }
  std::size_t count = 0;
  std::string last;
  each_line("table", path, 1004, [&](std::string_view text, bool ends) {
    if (count > 0 && ends) CHECK(text == line + std::to_string(count - 1));
    CHECK(ends == (count < 1001));
    ++count;
    last = text;
  });
  CHECK(count == 1002);
  CHECK(last == "end");
  CHECK_THROWS_MATCHES(each_line("table", path, 1001, [](std::string_view, bool) {}), InputFileError,
                       Message("table " + path + ": line 12 has more than 1001 bytes"));
}

TEST_CASE("a link to a file is followed") {
  const Folder folder;
  std::ofstream(folder / "file") << "text";
  fs::create_symlink("file", folder / "link");
  CHECK(read_input_file("image", folder / "link", 100) == "text");
}

TEST_CASE("anything but a regular file is refused at once") {
  const Folder folder;
  check_refused(folder / "nothing", "no such file");
  check_refused(folder / ".", "this is a directory, not a file");
  check_refused("/dev/zero", "this is a device, not a file");
  const std::string pipe = folder / "pipe", name = folder / "socket";
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  check_refused(pipe, "this is a pipe, not a file");
  fs::create_symlink("pipe", folder / "link");
  check_refused(folder / "link", "this is a pipe, not a file");
  sockaddr_un address{AF_UNIX, {}};
  std::strncpy(address.sun_path, name.c_str(), sizeof address.sun_path - 1);
  const int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
  REQUIRE(::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
  check_refused(name, "this is a socket, not a file");
  ::close(socket);
}
