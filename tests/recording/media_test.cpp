// Files of recordings that were cut short.
#include <catch2/catch.hpp>
#include <vector>

#include "recording/media.hpp"
#include "tests/games/scratch.hpp"
#include "tests/recording/film.hpp"

using namespace racebeam;

namespace {

constexpr std::size_t kHeight = 210, kSamples = 512;
constexpr std::size_t kY4mHeader = 39, kY4mFrame = 6 + 3 * 320 * kHeight, kWavHeader = 44;

// Writes frames until the budget is spent. Returns their number.
int fill(Media& media) {
  std::vector<std::uint8_t> pixels(160 * kHeight), samples(kSamples);
  for (int frames = 0;; ++frames) {
    try {
      pixels[static_cast<std::size_t>(frames)] = 0x46;
      media.sound(samples);
      media.frame(pixels);
    } catch (const BudgetSpent&) {
      return frames;
    }
  }
}

struct Film {
  explicit Film(MediaKind kind, std::size_t bytes) : budget(bytes) {
    const auto media = make_media(kind, folder.path(""), "a", {kHeight, palette(Format::kNtsc), 60}, budget);
    frames = fill(*media);
    media->commit();
    if (kind != MediaKind::kPng) file = test::read(folder.path(file_name(kind, "a")));
  }

  Scratch folder;
  DiskBudget budget;
  int frames = 0;
  std::string file;
};

std::size_t number_at(const std::string& bytes, std::size_t at) {
  std::size_t number = 0;
  for (std::size_t i = 4; i-- > 0;) number = number << 8 | static_cast<std::uint8_t>(bytes[at + i]);
  return number;
}

// The number of pictures of a GIF whose blocks end where the file ends; else -1.
int pictures_of_gif(const std::string& gif) {
  const auto byte = [&gif](std::size_t at) { return static_cast<std::uint8_t>(gif.at(at)); };
  int pictures = 0;
  std::size_t at = 13 + 768;
  while (byte(at) != ';') {
    pictures += byte(at) == ',';
    at += byte(at) == ',' ? 11 : 2;  // a picture's own header and code size; an extension's label
    while (byte(at) != 0) at += byte(at) + 1U;
    ++at;
  }
  return at + 1 == gif.size() ? pictures : -1;
}

}  // namespace

TEST_CASE("A Y4M that reaches its limit has whole frames") {
  const Film film(MediaKind::kY4m, 3 * kY4mFrame);
  CHECK(film.frames == 2);
  CHECK(film.file.size() == kY4mHeader + 2 * kY4mFrame);
  CHECK(film.budget.taken() == film.file.size());
}

TEST_CASE("A WAV that reaches its limit says how long it is") {
  const Film film(MediaKind::kWav, kWavHeader + 10 * kSamples + 100);
  CHECK(film.frames == 10);
  CHECK(film.file.size() == kWavHeader + 10 * kSamples);
  CHECK(number_at(film.file, 4) == film.file.size() - 8);
  CHECK(number_at(film.file, 40) == 10 * kSamples);
}

TEST_CASE("A GIF that reaches its limit ends as one must, whatever the limit") {
  for (std::size_t bytes = 20000; bytes < 20012; bytes += 3) {
    const Film film(MediaKind::kGif, bytes);
    CHECK(film.frames > 4);
    CHECK(pictures_of_gif(film.file) == (film.frames + 1) / 2);
    CHECK(film.file.size() <= bytes);
    CHECK(film.budget.taken() == film.file.size());
  }
}

TEST_CASE("A folder of PNGs that reaches its limit has whole pictures, and 4 KiB were left for each") {
  constexpr std::size_t kLimit = 60000;
  const Film film(MediaKind::kPng, kLimit);
  CHECK(film.frames > 4);
  CHECK(test::files_in(film.folder.path("a")) == static_cast<std::size_t>(film.frames));
  std::size_t bytes = 0;
  for (const auto& file : std::filesystem::directory_iterator(film.folder.path("a"))) {
    const std::string png = test::read(file.path());
    CHECK(png.substr(png.size() - 8, 4) == "IEND");
    bytes += png.size();
  }
  CHECK(film.budget.taken() == bytes);
  CHECK(bytes + static_cast<std::size_t>(film.frames) * kBytesBesideFile <= kLimit);
}

TEST_CASE("What has no room for its beginning is refused, and leaves nothing") {
  for (const MediaKind kind : {MediaKind::kGif, MediaKind::kY4m, MediaKind::kWav}) {
    const Scratch folder;
    DiskBudget budget(30);
    CHECK_THROWS_AS(make_media(kind, folder.path(""), "a", {kHeight, palette(Format::kNtsc), 60}, budget),
                    BudgetSpent);
    CHECK(test::files_in(folder.path("")) == 0);
  }
}
