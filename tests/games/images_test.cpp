#include "games/images.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "tests/games/scratch.hpp"
#include "tests/support/needed_rom.hpp"

using namespace racebeam;
using Catch::Contains;

namespace {

const std::string kGame = "title = 'Mine'\n[rule]\nstep = '''\nscore = ram[0x80]\nterminal = 0\n'''\n";

std::string bytes_of(char byte) { return std::string(4096, byte); }

char first_byte(const Cartridge* cartridge) {
  REQUIRE(cartridge != nullptr);
  return static_cast<char>(cartridge->image->bytes->front());
}

bool has(const Images& images, std::string_view name) {
  const auto names = images.names();
  return std::ranges::find(names, name) != names.end();
}

}  // namespace

TEST_CASE("images are found by the name of their game and by their MD5") {
  const Scratch scratch;
  Images images;
  REQUIRE(images.find("beamfall") != nullptr);
  CHECK(images.find("beamfall") != images.find("nobody"));
  images.add_file(scratch.write("nobody.bin", bytes_of('a')));
  const std::string md5 = images.find("nobody")->image->md5;
  CHECK(first_byte(images.find(md5)) == 'a');
  CHECK(has(images, "nobody"));
  CHECK_FALSE(has(images, md5));
  CHECK(images.find("someone") == nullptr);
}

TEST_CASE("of two images with one name, the first stays, unless the other is more certain") {
  const Scratch scratch;
  const std::string by_name = scratch.write("pong.bin", bytes_of('a')),
                    again = scratch.write("PONG.a26", bytes_of('b')),
                    given = scratch.write("game.bin", bytes_of('c')),
                    given_again = scratch.write("other.bin", bytes_of('d'));
  Images images;
  images.add_file(by_name);
  images.add_file(again);
  CHECK(first_byte(images.find("pong")) == 'a');
  images.add_file(given, "pong");
  CHECK(first_byte(images.find("pong")) == 'c');
  images.add_file(given_again, "pong");
  images.add_file(given_again, std::nullopt, scratch.write("pong.toml", kGame));  // is as certain
  images.add_file(by_name);
  CHECK(first_byte(images.find("pong")) == 'c');
  CHECK(images.find("beamfall")->image->md5 == load_image("builtin:beamfall")->md5);
  images.add_file(scratch.write("beamfall.bin", bytes_of('e')));  // is less certain than an MD5
  CHECK(images.find("beamfall")->image->md5 == load_image("builtin:beamfall")->md5);
}

TEST_CASE("an image whose MD5 is known replaces one that is only named like the game") {
  const auto pong = test::needed_rom_of("pong");
  if (!pong) return;
  const Scratch scratch;
  Images images;
  images.add_file(scratch.write("pong.bin", bytes_of('a')));
  images.add_file(scratch.write("other.bin", std::string(pong->bytes->begin(), pong->bytes->end())));
  CHECK(images.find("pong")->image->md5 == pong->md5);
}

TEST_CASE("an image that is put has its MD5 only, and replaces one with it") {
  const Scratch scratch;
  Images images;
  const auto image = load_image(scratch.write("nobody.bin", bytes_of('a')));
  CHECK(images.same(*image) == nullptr);
  CHECK(images.put(image, nullptr).game->name == "nobody");
  CHECK(images.same(*image) == image);
  CHECK(images.find("nobody") == nullptr);
  const auto game = load_game_file(scratch.write("mine.toml", kGame));
  CHECK(images.put(image, game).game->title == "Mine");
  CHECK(images.find(image->md5)->game->title == "Mine");
}

TEST_CASE("a folder's images are added, without those that cannot be") {
  const Scratch scratch;
  scratch.write("a.bin", bytes_of('a'));
  scratch.write("b.bin", "");
  scratch.write("c.zip", "no archive");
  scratch.write("d.txt", bytes_of('d'));
  scratch.write("e.bin", bytes_of('e'));
  Images images;
  const std::size_t before = images.names().size();
  images.add_folder(scratch.path(""));
  CHECK(images.names().size() == before + 2);
  CHECK(first_byte(images.find("a")) == 'a');
  CHECK(first_byte(images.find("e")) == 'e');
}

TEST_CASE("a rule is that of the catalogue or of an available image") {
  const Scratch scratch;
  Images images;
  CHECK(images.rules("pong")->name == "pong");
  CHECK(images.rules("mine") == nullptr);
  images.add_file(scratch.write("plain.bin", bytes_of('a')));
  CHECK(images.rules("plain") == nullptr);  // it has no rule
  images.add_file(scratch.write("b.bin", bytes_of('b')), std::nullopt, scratch.write("mine.toml", kGame));
  CHECK(images.rules("mine")->title == "Mine");
}

TEST_CASE("a warning tells of an image that another image's rule scores") {
  const Scratch scratch;
  Images images;
  const std::size_t before = images.warnings().size();
  images.add_file(scratch.write("pong.bin", bytes_of('a')));
  const auto warnings = images.warnings();
  REQUIRE(warnings.size() == before + 1);
  const std::string md5 = images.find("pong")->image->md5;
  CHECK(std::ranges::any_of(warnings, [&](const std::string& text) {
    return text.find(md5) != std::string::npos &&
           text.find("score and end may be wrong") != std::string::npos;
  }));
}

TEST_CASE("an image's own console is kept, and a scheme that does not fit is refused") {
  const Scratch scratch;
  Images images;
  PropertyOverrides console;
  console.set("height", "199");
  images.add_file(scratch.write("a.bin", bytes_of('a')), std::nullopt, std::nullopt, console);
  const Cartridge& cartridge = *images.find("a");
  CHECK(cartridge.game->properties_for(cartridge.image->md5).height == 199);
  PropertyOverrides wrong;
  wrong.set("scheme", "F4");  // takes 32 KiB
  CHECK_THROWS(images.add_file(scratch.write("b.bin", bytes_of('b')), std::nullopt, std::nullopt, wrong));
  CHECK(images.find("b") == nullptr);
}
