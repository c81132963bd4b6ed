// The program that makes a film: shell scripts in its place.
#include "recording/film_encoder.hpp"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <catch2/catch.hpp>

#include "recording/avi.hpp"
#include "tests/games/scratch.hpp"
#include "tests/recording/film.hpp"

using namespace racebeam;

namespace {

constexpr std::chrono::milliseconds kShort{200};

std::vector<std::string> shell(const std::string& script) { return {"sh", "-c", script}; }

std::size_t little_endian(const std::string& bytes, std::size_t at) {
  std::size_t number = 0;
  for (std::size_t i = 4; i-- > 0;) number = number << 8 | static_cast<std::uint8_t>(bytes.at(at + i));
  return number;
}

}  // namespace

TEST_CASE("An encoder reads all that is written, and has ended after finish") {
  const Scratch folder;
  FilmEncoder encoder(shell("cat > '" + folder.path("film") + "'; echo done"));
  const std::string bytes(1 << 20, 'x');
  for (int i = 0; i < 3; ++i) encoder.write(bytes);
  encoder.finish();
  CHECK(test::read(folder.path("film")) == bytes + bytes + bytes);
}

#if defined(__linux__)
TEST_CASE("An encoder has only its standard descriptors, and gets no signal of the terminal") {
  const Scratch folder;
  const int leaked = ::open("/dev/null", O_RDONLY);  // as a socket without FD_CLOEXEC
  FilmEncoder(shell("exec ls /proc/self/fd > '" + folder.path("fds") + "'")).finish();
  FilmEncoder(shell("exec cut -d' ' -f5 /proc/self/stat > '" + folder.path("group") + "'")).finish();
  ::close(leaked);
  CHECK(test::read(folder.path("fds")) == "0\n1\n2\n3\n");  // 3: what ls reads
  CHECK(std::stoi(test::read(folder.path("group"))) != ::getpgrp());
}
#endif

TEST_CASE("An encoder that fails is an error with its last words") {
  const auto reason = [](const std::string& script, std::size_t bytes) -> std::string {
    try {
      FilmEncoder encoder(shell(script), {}, kShort);
      for (std::size_t i = 0; i < bytes; i += 1000) encoder.write(std::string(1000, 'x'));
      encoder.finish();
    } catch (const EncoderFailed& failed) {
      return failed.what();
    }
    return "no failure";
  };
  CHECK(reason("echo one >&2; echo 'no such codec' >&2; exit 1", 0) == "sh failed: no such codec");
  CHECK(reason("echo 'no such codec' >&2; exit 1", 10'000'000) == "sh failed: no such codec");
  CHECK(reason("cat > /dev/null; exit 3", 1000) == "sh failed: it did not succeed");
  CHECK(reason("exec <&-; sleep 0.05", 10'000'000) == "sh failed: it does not read any more");
  CHECK(reason("sleep 30", 10'000'000) == "sh does nothing any more");
  CHECK_THROWS_WITH(FilmEncoder(shell("sleep 30"), [] { return true; }).finish(),
                    "sh is not waited for any more");
  CHECK(reason("sleep 30", 1000) == "sh does not end");
  CHECK(reason("yes 'much to say' >&2; cat > /dev/null", 1000) == "no failure");  // what is not read is lost
  CHECK_THROWS_WITH(FilmEncoder({"no-such-program"}),
                    "no-such-program is not installed: the PATH has no such program");
}

TEST_CASE("An encoder that is not needed any more is killed") {
  const Scratch folder;
  {
    FilmEncoder encoder(shell("echo $$ > '" + folder.path("pid") + "'; exec sleep 1000"));
    while (test::read(folder.path("pid")).find('\n') == std::string::npos) ::usleep(1000);
  }
  CHECK(::kill(std::stoi(test::read(folder.path("pid"))), 0) != 0);
}

TEST_CASE("The stream for an encoder is AVI, with the colours and rows of a bitmap") {
  const std::string header = avi_header({210, palette(Format::kNtsc), 60});
  CHECK(header.substr(0, 4) + header.substr(8, 4) == "RIFFAVI ");
  std::size_t next = 12;
  CHECK(header.substr(next + 8, 4) == "hdrl");
  next += 8 + little_endian(header, next + 4);
  CHECK(header.substr(next, 4) + header.substr(next + 8) == "LISTmovi");
  const std::size_t colours = header.find("strf") + 8 + 40;
  for (const std::size_t value : {0x00U, 0x46U, 0xFFU}) {
    const Rgb& colour = palette(Format::kNtsc)[value];
    CHECK(little_endian(header, colours + 4 * value) ==
          (std::size_t{colour.r} << 16U | std::size_t{colour.g} << 8U | colour.b));
  }
  std::vector<std::uint8_t> pixels(160 * 210), samples(512, 0x80);
  pixels[0] = 1;
  const std::string frame = avi_frame(pixels, 210, samples);
  CHECK(frame.size() == 8 + pixels.size() + 8 + samples.size());
  CHECK(frame[8 + 160 * 209] == 1);
  CHECK(frame.substr(8 + pixels.size(), 4) == "01wb");
}
