#include <catch2/catch.hpp>

#include <zlib.h>

#include <fstream>
#include <numeric>

#include "games/catalogue.hpp"
#include "games/rom_image.hpp"
#include "tests/games/scratch.hpp"

using namespace racebeam;
using Catch::Contains;

namespace {

std::string numbers(std::size_t size) {
  std::string bytes(size, '\0');
  std::iota(bytes.begin(), bytes.end(), '\0');
  return bytes;
}

std::string gzipped(const Scratch& scratch, const std::string& name, const std::string& bytes) {
  const std::string path = scratch.path(name);
  const gzFile file = gzopen(path.c_str(), "wb");
  gzwrite(file, bytes.data(), static_cast<unsigned>(bytes.size()));
  gzclose(file);
  return path;
}

std::string contents(const Image& image) { return {image.bytes->begin(), image.bytes->end()}; }

}  // namespace

TEST_CASE("an image is the bytes of its file, with their MD5 and the file's stem") {
  const Scratch scratch;
  const auto image = load_image(scratch.write("Space_War.A26", "abc"));
  CHECK(image->bytes->capacity() == 3);  // a server keeps all images of its folder
  CHECK(contents(*image) == "abc");
  CHECK(image->md5 == "900150983cd24fb0d6963f7d28e17f72");  // RFC 1321
  CHECK(image->stem == "space_war");
}

TEST_CASE("a gzip file is inflated before anything is made of it") {
  const Scratch scratch;
  const auto plain = load_image(scratch.write("plain.bin", numbers(4096)));
  const auto packed = load_image(gzipped(scratch, "game.bin.gz", numbers(4096)));
  CHECK(*packed->bytes == *plain->bytes);
  CHECK(packed->md5 == plain->md5);
  CHECK(packed->stem == "game");
}

TEST_CASE("an image may have 524288 bytes and no more") {
  const Scratch scratch;
  CHECK(load_image(scratch.write("big.bin", numbers(kMaxImageSize)))->bytes->size() == kMaxImageSize);
  CHECK_THROWS_WITH(load_image(scratch.write("bigger.bin", numbers(kMaxImageSize + 1))),
                    Contains("bigger.bin") && Contains("524288"));
  CHECK_THROWS_WITH(load_image(gzipped(scratch, "bomb.gz", numbers(100 * kMaxImageSize))),
                    Contains("524288"));
}

TEST_CASE("an image that cannot be had is refused with the reason") {
  const Scratch scratch;
  CHECK_THROWS_WITH(load_image(scratch.path("none.bin")), Contains("none.bin") && Contains("no such file"));
  CHECK_THROWS_WITH(load_image(""), Contains("no such file"));
  CHECK_THROWS_WITH(load_image(scratch.path("")), Contains("directory"));
  CHECK_THROWS_WITH(load_image(scratch.write("empty.bin", "")), Contains("empty"));
  CHECK_THROWS_WITH(load_image(gzipped(scratch, "empty.gz", "")), Contains("empty"));
}

TEST_CASE("a truncated or damaged gzip file is refused") {
  const Scratch scratch;
  std::ifstream whole(gzipped(scratch, "whole.gz", numbers(20000)), std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(whole), {}};
  CHECK_THROWS_WITH(load_image(scratch.write("cut.gz", bytes.substr(0, bytes.size() / 2))),
                    Contains("truncated"));
  bytes[bytes.size() - 6] = static_cast<char>(~bytes[bytes.size() - 6]);  // in the checksum
  CHECK_THROWS_WITH(load_image(scratch.write("bad.gz", bytes)), Contains("damaged"));
}

TEST_CASE("built-in images are loaded by name") {
  CHECK_THROWS_WITH(load_image("builtin:nobody"), Contains("no such built-in image"));
  for (const BuiltInImage& built_in : builtin_images()) {
    INFO(built_in.name);
    const auto image = load_image("builtin:" + std::string(built_in.name));
    CHECK(image->stem == built_in.name);
    CHECK(std::ranges::equal(*image->bytes, built_in.bytes));
    CHECK(image->md5 == md5_of(built_in.bytes));
    const Recognition found = recognise(*image);
    CHECK(found.game->name == built_in.name);
    CHECK(found.how == RecognisedBy::kMd5);
    CHECK(found.md5_matches);
  }
}
