#include <catch2/catch.hpp>

#include <zlib.h>

#include <filesystem>
#include <fstream>
#include <numeric>

#include "games/catalogue.hpp"
#include "games/rom_image.hpp"
#include "system/invalid_input.hpp"
#include "tests/games/scratch.hpp"
#include "tests/support/skip.hpp"

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
  CHECK(load_image(gzipped(scratch, "GAME.BIN.GZ", numbers(4096)))->stem == "game");
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

TEST_CASE("a gzip file may have several members, and other bytes after them") {
  const Scratch scratch;
  std::string bytes;
  for (const char* half : {"first", "second"}) {
    std::ifstream member(gzipped(scratch, half, half), std::ios::binary);
    bytes.append(std::istreambuf_iterator<char>(member), {});
  }
  CHECK(contents(*load_image(scratch.write("two.gz", bytes + "and more"))) == "firstsecond");
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

namespace {

// A zip archive, of which this writes what a reader needs.
class ZipFile {
 public:
  void add(const std::string& name, const std::string& bytes, bool deflated = true, unsigned flags = 0) {
    const std::string packed = deflated ? raw_deflated(bytes) : bytes;
    const auto crc = crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size()));
    const std::string common = number(flags, 2) + number(deflated ? 8 : 0, 2) + number(0, 4) +
                               number(crc, 4) + number(packed.size(), 4) + number(bytes.size(), 4) +
                               number(name.size(), 2) + number(0, 2);
    list_ +=
        "PK\1\2" + number(20, 2) + number(20, 2) + common + number(0, 10) + number(files_.size(), 4) + name;
    files_ += "PK\3\4" + number(20, 2) + common + name + packed;
    ++count_;
  }
  std::string bytes() const {
    return files_ + list_ + "PK\5\6" + number(0, 4) + number(count_, 2) + number(count_, 2) +
           number(list_.size(), 4) + number(files_.size(), 4) + number(0, 2);
  }

 private:
  static std::string number(std::size_t value, int bytes) {
    std::string text;
    for (; bytes > 0; --bytes, value >>= 8) text += static_cast<char>(value & 0xFF);
    return text;
  }
  static std::string raw_deflated(const std::string& bytes) {
    std::string packed(bytes.size() + 100, '\0');
    z_stream stream{};
    deflateInit2(&stream, 9, Z_DEFLATED, -MAX_WBITS, 9, Z_DEFAULT_STRATEGY);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
    stream.avail_in = static_cast<uInt>(bytes.size());
    stream.next_out = reinterpret_cast<Bytef*>(packed.data());
    stream.avail_out = static_cast<uInt>(packed.size());
    deflate(&stream, Z_FINISH);
    packed.resize(packed.size() - stream.avail_out);
    deflateEnd(&stream);
    return packed;
  }

  std::string files_, list_;
  std::size_t count_ = 0;
};

}  // namespace

TEST_CASE("a zip archive with one image is read as this image") {
  const Scratch scratch;
  const auto plain = load_image(scratch.write("plain.bin", numbers(4096)));
  for (const bool deflated : {true, false}) {
    ZipFile zip;
    zip.add("folder/", "", false);
    zip.add("readme.txt", "the rules", deflated);
    zip.add("__MACOSX/folder/._Game.bin", "fork", deflated);
    zip.add("folder/Game.bin", numbers(4096), deflated);
    const auto packed = load_image(scratch.write("collection.zip", zip.bytes()));
    CHECK(*packed->bytes == *plain->bytes);
    CHECK(packed->md5 == plain->md5);
    CHECK(packed->stem == "game");
  }
}

TEST_CASE("other archives are refused with the reason") {
  const Scratch scratch;
  const auto refusal = [&](const ZipFile& zip) {
    try {
      load_image(scratch.write("a.zip", zip.bytes()));
    } catch (const InvalidInput& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  ZipFile none, two, bomb, encrypted, small;
  CHECK_THAT(refusal(none), Contains("a.zip: the zip archive has no file that ends in"));
  two.add("one.bin", numbers(4096));
  two.add("two.a26", numbers(2048));
  CHECK_THAT(refusal(two), Contains("has 2 images") && Contains("one.bin, two.a26"));
  bomb.add("bomb.bin", std::string(200 * kMaxImageSize, '\0'));
  CHECK_THAT(refusal(bomb), Contains("bomb.bin in it has more than 524288 bytes"));
  encrypted.add("secret.bin", numbers(4096), true, 1);
  CHECK_THAT(refusal(encrypted), Contains("secret.bin in it is encrypted"));
  for (const std::size_t images : {8, 9}) {
    ZipFile many;
    for (std::size_t number = 1; number <= images; ++number)
      many.add(std::to_string(number) + ".bin", "bytes");
    CHECK_THAT(refusal(many), Catch::EndsWith(images == 8 ? "7.bin, 8.bin" : "7.bin, 8.bin and others"));
  }
  ZipFile empty;
  empty.add("game.bin", "");
  CHECK_THAT(refusal(empty), Contains("a.zip: image game: it is empty"));
  CHECK_THROWS_WITH(load_image(scratch.write("a.7z", "7z\xBC\xAF\x27\x1C and more")),
                    Contains("7z archives"));
  for (const std::string name : {"b.zip", "b.7z"})
    CHECK_THROWS_WITH(load_image(scratch.write(name, "<html>not found</html>")),
                      Contains(name + ": the file is named as an archive, but it is not a zip archive"));
  CHECK_THROWS_WITH(load_image(scratch.write("c.zip", "")), Contains("c.zip: the file is empty"));
}

TEST_CASE("a zip archive in several parts or packed by another method is refused with the reason") {
  const Scratch scratch;
  ZipFile zip;
  zip.add("game.bin", numbers(300), false);
  const auto load_with = [&](std::size_t at, char byte) {
    std::string bytes = zip.bytes();
    bytes[at] = byte;
    load_image(scratch.write("other.zip", bytes));
  };
  const std::size_t entry = zip.bytes().find("PK\1\2"), end = zip.bytes().find("PK\5\6");
  CHECK_THROWS_WITH(load_with(entry + 10, 9),
                    Contains("game.bin in it is packed by method 9; 0 and 8 are read"));
  for (const std::size_t count : {end + 8, end + 10})
    CHECK_THROWS_WITH(load_with(count, 2), Contains("the zip archive has several parts"));
}

TEST_CASE("a damaged zip archive is refused, or its image is whole") {
  const Scratch scratch;
  ZipFile zip;
  zip.add("game.bin", numbers(300));
  const std::string bytes = zip.bytes();
  const auto whole = load_image(scratch.write("whole.zip", bytes));
  const auto survives = [&](const std::string& damaged) {
    try {
      const auto image = load_image(scratch.write("damaged.zip", damaged));
      return *image->bytes == *whole->bytes || damaged.substr(0, 4) != bytes.substr(0, 4);
    } catch (const InvalidInput&) {
      return true;
    }
  };
  for (std::size_t size = 4; size < bytes.size(); ++size) CHECK(survives(bytes.substr(0, size)));
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    for (const int bits : {0x01, 0x80, 0xFF}) {
      std::string damaged = bytes;
      damaged[at] = static_cast<char>(damaged[at] ^ bits);
      INFO(at);
      CHECK(survives(damaged));
    }
  }
}

TEST_CASE("a file in a zip archive has as many bytes as an image may have, and its sum") {
  const Scratch scratch;
  for (const bool deflated : {true, false}) {
    ZipFile largest, larger, damaged;
    largest.add("game.bin", numbers(kMaxImageSize), deflated);
    larger.add("game.bin", numbers(kMaxImageSize + 1), deflated);
    CHECK(load_image(scratch.write("largest.zip", largest.bytes()))->bytes->size() == kMaxImageSize);
    CHECK_THROWS_WITH(load_image(scratch.write("larger.zip", larger.bytes())),
                      Contains("game.bin in it has more than 524288 bytes"));
    damaged.add("game.bin", numbers(4096), deflated);
    std::string bytes = damaged.bytes();
    bytes[bytes.find("PK\1\2") + 16] ^= 1;
    CHECK_THROWS_WITH(load_image(scratch.write("damaged.zip", bytes)),
                      Contains("the zip archive is damaged"));
  }
}

TEST_CASE("a zip archive may end in a comment of 65535 bytes") {
  const Scratch scratch;
  ZipFile zip;
  zip.add("game.bin", numbers(4096));
  const auto load = [&](std::size_t comment) {
    return load_image(scratch.write("comment.zip", zip.bytes() + std::string(comment, 'x')));
  };
  CHECK(load(65535)->bytes->size() == 4096);
  CHECK_THROWS_WITH(load(65536), Contains("the zip archive is damaged"));
}

TEST_CASE("a zip archive whose name of a file goes beyond its end is damaged") {
  const Scratch scratch;
  ZipFile zip;
  zip.add("game.bin", numbers(300));
  std::string bytes = zip.bytes();
  const std::size_t length = bytes.find("PK\1\2") + 28;
  const std::size_t name = length - 28 + 46;
  const auto refused_with = [&](std::size_t size) {
    bytes[length] = static_cast<char>(size & 0xFF);
    bytes[length + 1] = static_cast<char>(size >> 8);
    try {
      load_image(scratch.write("long.zip", bytes));
    } catch (const InvalidInput& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK_THAT(refused_with(bytes.size() - name), Contains("has no file that ends in"));  // up to its end
  CHECK_THAT(refused_with(bytes.size() - name + 1), Contains("the zip archive is damaged"));
}

TEST_CASE("an image of 32 to 2047 bytes repeats in 2K, up to their end") {
  const Scratch scratch;
  for (const std::size_t size : {32U, 100U, 512U, 1024U, 2047U}) {
    INFO(size);
    const auto image = load_image(scratch.write("small.bin", numbers(size)));
    REQUIRE(image->bytes->size() == 2048);
    for (std::size_t i = 1; i <= 2048; ++i)
      REQUIRE((*image->bytes)[2048 - i] == static_cast<std::uint8_t>(size - 1 - (i - 1) % size));
    CHECK(image->md5 == md5_of(image->file()));
    CHECK(image->file().size() == size);
  }
  CHECK(load_image(scratch.write("tiny.bin", numbers(31)))->bytes->size() == 31);
}

namespace {

std::vector<std::string> names_of(const std::vector<std::string>& paths) {
  std::vector<std::string> names;
  for (const std::string& path : paths) names.push_back(std::filesystem::path(path).filename().string());
  return names;
}

using Names = std::vector<std::string>;

}  // namespace

TEST_CASE("a folder's images are its files that are named like images") {
  const Scratch scratch;
  for (const char* name :
       {"a.bin", "B.A26", "c.rom.gz", "d.zip", "e.7z", "f.gz", "g.txt", "h.bin.txt", "bin"})
    scratch.write(name, "bytes");
  std::filesystem::create_directory(scratch.path("folder.bin"));
  CHECK(names_of(image_files(scratch.path(""))) == Names{"B.A26", "a.bin", "c.rom.gz", "d.zip", "e.7z"});
  CHECK(broken_image_links(scratch.path("")).empty());
  CHECK_THROWS_WITH(image_files(scratch.path("none")), Contains("cannot list the folder"));
}

TEST_CASE("a link to an image is one, and a broken link is found") {
  namespace fs = std::filesystem;
  const Scratch scratch;
  scratch.write("a.bin", "bytes");
  std::error_code error;
  fs::create_symlink("a.bin", scratch.path("link.bin"), error);
  if (error) return test::leave_out("this system makes no links");
  fs::create_symlink("none.bin", scratch.path("broken.bin"));
  fs::create_symlink("none.bin", scratch.path("broken.txt"));
  CHECK(names_of(image_files(scratch.path(""))) == Names{"a.bin", "link.bin"});
  CHECK(names_of(broken_image_links(scratch.path(""))) == Names{"broken.bin"});
  fs::create_symlink("nowhere", scratch.path("away"));
  CHECK_THROWS_WITH(image_files(scratch.path("away")),
                    Contains("it is a link to 'nowhere', which is not there"));
}

TEST_CASE("built-in images are loaded by name") {
  CHECK_THROWS_WITH(load_image("builtin:nobody"),
                    Contains("unknown built-in image; accepted: builtin:beamfall, builtin:updraft"));
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
