// Pictures, films and sound as files, which are read again. The first bytes are the kind, the format, the
// height and the number of frames. The rest are the pixels, repeated as often as necessary, and the sound.
#include "recording/media.hpp"

#include <png.h>

#include <array>
#include <fstream>
#include <iterator>
#include <vector>

#include "emulator/tia/sound.hpp"
#include "fuzz/support/folder.hpp"
#include "fuzz/support/gif_reader.hpp"
#include "fuzz/support/target.hpp"
#include "recording/lzw.hpp"

namespace racebeam::fuzz {
namespace {

using Buffer = std::vector<std::uint8_t>;

constexpr std::size_t kWidth = kPictureWidth / 2;

struct Film {
  MediaKind kind;
  std::size_t height;
  const Palette& palette;
  int rate;
  std::vector<Buffer> frames;
  std::array<std::uint8_t, kSamplesPerBlock> sound;
};

Film make_film(Reader& reader) {
  constexpr std::array kFormats = {Format::kNtsc, Format::kPal, Format::kPal60, Format::kSecam};
  const auto kind = static_cast<MediaKind>(reader.byte() % 4);
  const Format format = kFormats[reader.byte() % kFormats.size()];
  Film film{kind, 1 + reader.byte() % 24U, palette(format), format == Format::kNtsc ? 60 : 50, {}, {}};
  film.frames.resize(reader.byte() % 6U);
  const Bytes content = reader.rest();
  std::size_t at = 0;
  const auto next = [&] { return content.empty() ? std::uint8_t{0} : content[at++ % content.size()]; };
  for (Buffer& frame : film.frames) {
    frame.resize(film.height * kWidth);
    std::ranges::generate(frame, next);
  }
  std::ranges::generate(film.sound, next);
  return film;
}

Buffer bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

Buffer doubled(const Buffer& pixels) {
  Buffer wide;
  for (const std::uint8_t pixel : pixels) wide.insert(wide.end(), 2, pixel);
  return wide;
}

Buffer colors_of(const Buffer& pixels, const Palette& palette) {
  Buffer colors;
  for (const std::uint8_t pixel : pixels) {
    const Rgb& color = palette[pixel];
    for (const std::uint8_t part : {color.r, color.g, color.b}) colors.push_back(part);
  }
  return colors;
}

void check_png(const Film& film, const std::string& folder) {
  for (std::size_t n = 0; n < film.frames.size(); ++n) {
    const Buffer file = bytes_of(folder + "/00000" + std::to_string(n) + ".png");
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    require(png_image_begin_read_from_memory(&image, file.data(), file.size()) != 0, "libpng reads it",
            image.message);
    require(image.width == kPictureWidth && image.height == film.height, "a PNG has the size of the screen");
    image.format = PNG_FORMAT_RGB;
    Buffer colors(PNG_IMAGE_SIZE(image));
    require(png_image_finish_read(&image, nullptr, colors.data(), 0, nullptr) != 0, "libpng reads it",
            image.message);
    require(colors == colors_of(doubled(film.frames[n]), film.palette), "a PNG shows what was recorded");
  }
}

void check_gif(const Film& film, const std::string& path) {
  const Gif gif = read_gif(bytes_of(path));
  require(gif.width == kPictureWidth && gif.height == film.height, "a GIF has the size of the screen");
  require(gif.frames.size() == (film.frames.size() + 1) / 2, "a GIF has every second frame");
  for (std::size_t n = 0; n < gif.frames.size(); ++n)
    require(gif.frames[n] == doubled(film.frames[2 * n]), "a GIF shows what was recorded");
}

void check_y4m(const Film& film, const std::string& path) {
  const Buffer file = bytes_of(path);
  const std::string_view text = text_of(file);
  require(text.starts_with("YUV4MPEG2 W320 H" + std::to_string(film.height) + " "),
          "a Y4M begins with its size");
  const std::size_t head = text.find('\n') + 1,
                    frame = std::string_view("FRAME\n").size() + 6 * kWidth * film.height;
  require(text.size() == head + film.frames.size() * frame, "a Y4M has all frames");
}

void check_wav(const Film& film, const std::string& path) {
  const Buffer file = bytes_of(path);
  const auto number_at = [&](std::size_t at) {
    return file[at] | file[at + 1] << 8 | file[at + 2] << 16 | file[at + 3] << 24;
  };
  constexpr std::size_t kHead = 44;
  const std::size_t samples = film.frames.size() * film.sound.size();
  require(file.size() == kHead + samples, "a WAV has all samples");
  require(text_of(file).starts_with("RIFF") && number_at(4) == static_cast<int>(file.size() - 8),
          "a WAV knows its size");
  require(number_at(40) == static_cast<int>(samples), "a WAV knows the number of its samples");
  for (std::size_t n = 0; n < film.frames.size(); ++n)
    require(
        std::ranges::equal(Bytes(file).subspan(kHead + n * film.sound.size(), film.sound.size()), film.sound),
        "a WAV has the sound that was recorded");
}

// Pictures of any size: codes grow, and the table is reset.
void check_lzw(Bytes pixels) {
  Buffer packed;
  Lzw lzw;
  lzw.append(packed, pixels);
  Reader reader(packed);
  require(std::ranges::equal(unpack_lzw(reader), pixels), "LZW gives back what it was made of");
  require(reader.empty(), "nothing follows the last block");
}

}  // namespace

void run(Bytes input) {
  Reader reader(input);
  check_lzw(input);
  const Film film = make_film(reader);
  const ScratchFolder folder;
  DiskBudget budget(1 << 24);
  const auto media =
      make_media(film.kind, folder.path(), "film", {film.height, film.palette, film.rate}, budget);
  for (const Buffer& frame : film.frames) {
    media->frame(frame);
    media->sound(film.sound);
  }
  media->commit();
  const std::string path = folder.path() + "/" + file_name(film.kind, "film");
  switch (film.kind) {
    case MediaKind::kPng: return check_png(film, path);
    case MediaKind::kGif: return check_gif(film, path);
    case MediaKind::kY4m: return check_y4m(film, path);
    case MediaKind::kWav: return check_wav(film, path);
    case MediaKind::kPicture:  // one picture of kPng
    case MediaKind::kWebm:
    case MediaKind::kMp4: return;  // not made: they need another program
  }
}

}  // namespace racebeam::fuzz
