#include "recording/avi.hpp"

#include <initializer_list>
#include <string_view>

#include "emulator/tia/sound.hpp"

namespace racebeam {
namespace {

constexpr std::size_t kUnknown = 0;  // the size of a stream whose end is not known
constexpr std::size_t kWidth = 160;
constexpr int kBitsAPixel = 8, kBitsASample = 8;
constexpr std::size_t kColours = 256;

// Appends numbers of this many bytes each, the lowest byte first.
void put(std::string& out, int bytes, std::initializer_list<std::size_t> numbers) {
  for (const std::size_t number : numbers)
    for (int i = 0; i < bytes; ++i) out.push_back(static_cast<char>(number >> 8 * i));
}

std::string_view as_text(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void put_chunk(std::string& out, std::string_view name, std::string_view content) {
  out.append(name);
  put(out, 4, {content.size()});
  out.append(content);
  if (content.size() % 2 != 0) out.push_back(0);
}

std::string list(std::string_view kind,
                 std::initializer_list<std::pair<std::string_view, std::string>> chunks) {
  std::string content;
  content.append(kind);
  for (const auto& [name, chunk] : chunks) put_chunk(content, name, chunk);
  return content;
}

std::string main_header(std::size_t rate, std::size_t height) {
  constexpr std::size_t kMicroseconds = 1'000'000, kStreams = 2;
  std::string header;
  put(header, 4, {kMicroseconds / rate, 0, 0, 0, 0, 0, kStreams, 0, kWidth, height, 0, 0, 0, 0});
  return header;
}

// The header of a stream of `rate` units a second. A sample has `sample` bytes; 0: their number varies.
std::string stream_header(std::string_view kind, std::string_view handler, std::size_t rate,
                          std::size_t sample) {
  std::string header;
  header.append(kind);
  header.append(handler);
  put(header, 4, {0, 0, 0, 1, rate, 0, kUnknown, 0, 0xFFFFFFFF, sample, 0, 0});
  return header;
}

// A BITMAPINFO structure.
std::string picture_format(const Footage& footage) {
  std::string format;
  put(format, 4, {40, kWidth, footage.height});
  put(format, 2, {1, kBitsAPixel});
  put(format, 4, {0, kWidth * footage.height, 0, 0, kColours, 0});
  for (std::size_t i = 0; i < kColours; ++i) {
    const Rgb& colour = footage.palette[i];
    put(format, 1, {colour.b, colour.g, colour.r, 0});
  }
  return format;
}

// A WAVEFORMATEX structure.
std::string sound_format(std::size_t rate) {
  std::string format;
  put(format, 2, {1, 1});        // PCM, one channel
  put(format, 4, {rate, rate});  // samples and bytes a second
  put(format, 2, {1, kBitsASample, 0});
  return format;
}

}  // namespace

std::string avi_header(const Footage& footage) {
  const auto rate = static_cast<std::size_t>(footage.rate), sound_rate = rate * kSamplesPerBlock;
  const std::string picture =
      list("strl", {{"strh", stream_header("vids", "DIB ", rate, 0)}, {"strf", picture_format(footage)}});
  const std::string sound = list("strl", {{"strh", stream_header("auds", {"\0\0\0\0", 4}, sound_rate, 1)},
                                          {"strf", sound_format(sound_rate)}});
  std::string out;
  out.append("RIFF");
  put(out, 4, {kUnknown});
  out.append("AVI ");
  put_chunk(out, "LIST",
            list("hdrl", {{"avih", main_header(rate, footage.height)}, {"LIST", picture}, {"LIST", sound}}));
  out.append("LIST");
  put(out, 4, {kUnknown});
  out.append("movi");
  return out;
}

// A bitmap has its lowest row first.
std::string avi_frame(std::span<const std::uint8_t> pixels, std::size_t height,
                      std::span<const std::uint8_t> samples) {
  std::string bitmap;
  bitmap.reserve(pixels.size());
  for (std::size_t row = height; row-- > 0;) {
    bitmap.append(as_text(pixels.subspan(row * kWidth, kWidth)));
  }
  std::string out;
  put_chunk(out, "00db", bitmap);
  put_chunk(out, "01wb", as_text(samples));
  return out;
}

}  // namespace racebeam
