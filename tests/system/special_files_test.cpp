// Links, devices, pipes and sockets, whose paths look like those of files.
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "system/input_file.hpp"
#include "tests/games/scratch.hpp"

namespace fs = std::filesystem;
using namespace racebeam;
using Catch::Matchers::Message;

namespace {

void check_refused(const std::string& path, const std::string& reason) {
  CHECK_THROWS_MATCHES(read_input_file("image", path, 100), InputFileError,
                       Message("image " + path + ": " + reason));
}

}  // namespace

TEST_CASE("a link to a file is followed") {
  const Scratch folder;
  std::ofstream(folder.path("file")) << "text";
  fs::create_symlink("file", folder.path("link"));
  CHECK(read_input_file("image", folder.path("link"), 100) == "text");
}

TEST_CASE("a device, a pipe or a socket is refused at once") {
  const Scratch folder;
  check_refused("/dev/zero", "this is a device, not a file");
  const std::string pipe = folder.path("pipe"), name = folder.path("socket");
  REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  check_refused(pipe, "this is a pipe, not a file");
  fs::create_symlink("pipe", folder.path("link"));
  check_refused(folder.path("link"), "this is a pipe, not a file");
  sockaddr_un address{AF_UNIX, {}};
  std::strncpy(address.sun_path, name.c_str(), sizeof address.sun_path - 1);
  const int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
  REQUIRE(::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
  check_refused(name, "this is a socket, not a file");
  ::close(socket);
}
