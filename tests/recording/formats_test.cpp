// Whether recordings are what the specifications of their formats say, from the first byte to the last.
// Comparisons of bytes are in parentheses, so that a failure does not print them.
#include <zlib.h>

#include <catch2/catch.hpp>

#include "recording/avi.hpp"
#include "tests/games/scratch.hpp"
#include "tests/recording/film.hpp"
#include "tests/recording/lzw_decoder.hpp"

using namespace racebeam;
using namespace std::string_literals;

namespace {

constexpr std::size_t kHeight = 3, kPixels = 160 * kHeight;
constexpr int kRate = 60;

// Red, green, blue, white, and greys.
const Palette& colours() {
  static const Palette kColours = [] {
    Palette palette{};
    for (std::size_t i = 0; i < palette.size(); ++i) {
      const auto grey = static_cast<std::uint8_t>(i);
      palette[i] = {grey, grey, grey};
    }
    palette[1] = {255, 0, 0};
    palette[2] = {0, 255, 0};
    palette[3] = {0, 0, 255};
    palette[4] = {255, 255, 255};
    return palette;
  }();
  return kColours;
}

Footage footage() { return {kHeight, colours(), kRate}; }

// A picture of which each row differs, and pixels beside each other, too.
std::vector<std::uint8_t> pixels() {
  std::vector<std::uint8_t> found(kPixels);
  for (std::size_t i = 0; i < found.size(); ++i) found[i] = static_cast<std::uint8_t>(i % 7 + i / 160);
  return found;
}

// Numbers of this many bytes, the lowest first.
std::string numbers(int bytes, std::initializer_list<std::uint32_t> values) {
  std::string text;
  for (const std::uint32_t value : values)
    for (int i = 0; i < bytes; ++i) text += static_cast<char>(value >> 8 * i & 0xFF);
  return text;
}

std::string text_of(const std::vector<std::uint8_t>& bytes) { return {bytes.begin(), bytes.end()}; }

// The file of a film with this many of these pictures, and their sound.
std::string film(MediaKind kind, int frames) {
  const Scratch folder;
  DiskBudget budget(10'000'000);
  const auto media = make_media(kind, folder.path(""), "a", footage(), budget);
  for (int frame = 0; frame < frames; ++frame) {
    media->sound(std::vector<std::uint8_t>(512, static_cast<std::uint8_t>(frame)));
    media->frame(pixels());
  }
  media->commit();
  return test::read(folder.path(file_name(kind, "a")));
}

std::string chunk(const std::string& name, const std::string& content) {
  return name + numbers(4, {static_cast<std::uint32_t>(content.size())}) + content;
}

// Each pixel twice.
std::vector<std::uint8_t> wide(const std::vector<std::uint8_t>& narrow) {
  std::vector<std::uint8_t> found;
  for (const std::uint8_t pixel : narrow) found.insert(found.end(), 2, pixel);
  return found;
}

}  // namespace

// "AVI RIFF File Reference" (Microsoft): AVIMAINHEADER, AVISTREAMHEADER, BITMAPINFOHEADER, WAVEFORMATEX.
TEST_CASE("An AVI has a stream of bitmaps and one of sound, and an end that is not known") {
  std::string palette;
  for (const Rgb& colour : colours()) palette += numbers(1, {colour.b, colour.g, colour.r, 0});
  const std::string main = numbers(4, {16666, 0, 0, 0, 0, 0, 2, 0, 160, kHeight, 0, 0, 0, 0});
  const std::string pictures = "vidsDIB " + numbers(4, {0, 0, 0, 1, kRate, 0, 0, 0, 0xFFFFFFFF, 0, 0, 0});
  const std::string bitmap = numbers(4, {40, 160, kHeight}) + numbers(2, {1, 8}) +
                             numbers(4, {0, 160 * kHeight, 0, 0, 256, 0}) + palette;
  const std::string sound = "auds"s + numbers(4, {0, 0, 0, 0, 1, 30720, 0, 0, 0, 0xFFFFFFFF, 1, 0, 0});
  const std::string wave = numbers(2, {1, 1}) + numbers(4, {30720, 30720}) + numbers(2, {1, 8, 0});
  const auto stream = [](const std::string& header, const std::string& format) {
    return chunk("LIST", "strl" + chunk("strh", header) + chunk("strf", format));
  };
  const std::string headers =
      chunk("LIST", "hdrl" + chunk("avih", main) + stream(pictures, bitmap) + stream(sound, wave));
  CHECK((avi_header(footage()) ==
         "RIFF" + numbers(4, {0}) + "AVI " + headers + "LIST" + numbers(4, {0}) + "movi"));
}

TEST_CASE("A picture of an AVI has its lowest row first, and sound with an odd number of samples is padded") {
  const std::string rows = text_of(pixels());
  const std::string picture =
      chunk("00db", rows.substr(320, 160) + rows.substr(160, 160) + rows.substr(0, 160));
  const std::vector<std::uint8_t> samples = {7, 8, 9};
  CHECK((avi_frame(pixels(), kHeight, samples) == picture + chunk("01wb", "\x07\x08\x09") + numbers(1, {0})));
  CHECK((avi_frame(pixels(), kHeight, {}) == picture + chunk("01wb", "")));
}

TEST_CASE("A WAV has PCM with eight bits and one channel") {
  const std::string header =
      chunk("fmt ", numbers(2, {1, 1}) + numbers(4, {30720, 30720}) + numbers(2, {1, 8}));
  const std::string samples = std::string(512, 0) + std::string(512, 1);
  CHECK((film(MediaKind::kWav, 2) == chunk("RIFF", "WAVE" + header + chunk("data", samples))));
}

// Colours of ITU-R BT.601 with Y from 16 to 235.
TEST_CASE("A Y4M has the planes Y, U and V of each picture, and each pixel twice") {
  constexpr std::uint8_t kColours[][3] = {
      {16, 128, 128}, {81, 90, 240}, {145, 54, 34}, {41, 240, 110}, {235, 128, 128}};
  std::string frame = "FRAME\n";
  for (std::size_t plane = 0; plane < 3; ++plane)
    for (const std::uint8_t pixel : wide(pixels())) {
      const auto grey = static_cast<std::uint8_t>(plane == 0 ? 16 + (219 * pixel + 127) / 255 : 128);
      frame += static_cast<char>(pixel < 5 ? kColours[pixel][plane] : grey);
    }
  CHECK((film(MediaKind::kY4m, 2) == "YUV4MPEG2 W320 H3 F60:1 Ip A1:1 C444\n" + frame + frame));
}

// GIF89a, 18 to 26. Pictures of 2/60 s are shown for 3 or 4 hundredths, so that ten take 33.
TEST_CASE("A GIF has every second picture, for as long as two frames take, and repeats") {
  const std::string gif = film(MediaKind::kGif, 20);
  std::string head = "GIF89a" + numbers(2, {320, kHeight}) + numbers(1, {0xF7, 0, 0});
  for (const Rgb& colour : colours()) head += numbers(1, {colour.r, colour.g, colour.b});
  head += "\x21\xFF\x0BNETSCAPE2.0" + numbers(1, {3, 1, 0, 0, 0});
  REQUIRE((gif.substr(0, head.size()) == head));
  std::size_t at = head.size(), time = 0;
  int pictures = 0;
  for (; gif.at(at) == '\x21'; ++pictures) {
    const auto delay = static_cast<std::uint8_t>(gif.at(at + 4));
    time += delay;
    CHECK((delay == 3 || delay == 4));
    const std::string before = "\x21\xF9\x04"s + numbers(1, {0, delay, 0, 0, 0}) + "," +
                               numbers(2, {0, 0, 320, kHeight}) + numbers(1, {0});
    REQUIRE((gif.substr(at, before.size()) == before));
    at += before.size();
    std::size_t end = at + 1;
    while (gif.at(end) != 0) end += static_cast<std::uint8_t>(gif[end]) + 1U;
    const test::Decoded picture = test::decoded(test::Bytes(
        gif.begin() + static_cast<std::ptrdiff_t>(at), gif.begin() + static_cast<std::ptrdiff_t>(end + 1)));
    CHECK((picture.pixels == wide(pixels())));
    at = end + 1;
  }
  CHECK(gif.substr(at) == ";");
  CHECK(pictures == 10);
  CHECK(time == 33);
}

TEST_CASE("A PNG has rows without a filter, a palette, and sums of its chunks") {
  const std::string png = film(MediaKind::kPicture, 1);
  const auto number = [&png](std::size_t at) {
    std::uint32_t found = 0;
    for (std::size_t i = 0; i < 4; ++i) found = found << 8 | static_cast<std::uint8_t>(png.at(at + i));
    return found;
  };
  std::vector<std::pair<std::string, std::string>> chunks;
  REQUIRE((png.substr(0, 8) == "\x89PNG\r\n\x1A\n"));
  for (std::size_t at = 8; at < png.size();) {
    const std::size_t size = number(at);
    const std::string content = png.substr(at + 4, 4 + size);
    CHECK(number(at + 8 + size) ==
          ::crc32(0, reinterpret_cast<const Bytef*>(content.data()), static_cast<uInt>(content.size())));
    chunks.emplace_back(content.substr(0, 4), content.substr(4));
    at += 12 + size;
  }
  REQUIRE(chunks.size() == 4);
  CHECK((chunks[0] == std::pair("IHDR"s, "\0\0\x01\x40\0\0\0\x03\x08\x03\0\0\0"s)));
  std::string palette;
  for (const Rgb& colour : colours()) palette += numbers(1, {colour.r, colour.g, colour.b});
  CHECK((chunks[1] == std::pair("PLTE"s, palette)));
  CHECK((chunks[2].first == "IDAT"));
  CHECK((chunks[3] == std::pair("IEND"s, ""s)));
  std::vector<std::uint8_t> rows(kHeight * 321 + 1);
  uLongf size = rows.size();
  REQUIRE(::uncompress(rows.data(), &size, reinterpret_cast<const Bytef*>(chunks[2].second.data()),
                       chunks[2].second.size()) == Z_OK);
  CHECK(size == kHeight * 321);
  const std::vector<std::uint8_t> expected = wide(pixels());
  for (std::size_t row = 0; row < kHeight; ++row) {
    CHECK(rows[321 * row] == 0);
    CHECK(std::equal(expected.begin() + static_cast<std::ptrdiff_t>(320 * row),
                     expected.begin() + static_cast<std::ptrdiff_t>(320 * row + 320),
                     rows.begin() + static_cast<std::ptrdiff_t>(321 * row + 1)));
  }
}

TEST_CASE("Pictures of a folder of PNGs are numbered, and each is what a file of one picture is") {
  const Scratch folder;
  DiskBudget budget(1'000'000);
  const auto media = make_media(MediaKind::kPng, folder.path(""), "a", footage(), budget);
  for (int frame = 0; frame < 2; ++frame) media->frame(pixels());
  media->commit();
  const std::string picture = film(MediaKind::kPicture, 1);
  for (const char* const name : {"a/000000.png", "a/000001.png"})
    CHECK((test::read(folder.path(name)) == picture));
  CHECK(test::files_in(folder.path("a")) == 2);
}
