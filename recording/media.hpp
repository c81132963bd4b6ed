// A recording of frames or of sound, in one of several file formats.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "emulator/tia/palette.hpp"
#include "recording/atomic_file.hpp"

namespace racebeam {

constexpr std::size_t kPictureWidth = 320;  // every pixel is doubled, since the console's pixels are wide

// The format of what is recorded.
struct Footage {
  std::size_t height;      // rows of 160 pixels
  const Palette& palette;  // what their bytes mean
  int rate;                // frames a second: 60, or 50
};

class Media {
 public:
  virtual ~Media() = default;

  // Both throw BudgetSpent, or std::runtime_error if the system refuses to write. Then this frame is not
  // recorded, and the frames before it can still be committed. After EncoderFailed
  // (recording/film_encoder.hpp), they cannot.
  virtual void frame(std::span<const std::uint8_t> pixels) = 0;  // height x 160 palette indices
  virtual void sound(std::span<const std::uint8_t> samples) = 0;

  // Ends the recording: makes it visible under its name. Throws std::runtime_error.
  virtual void commit() = 0;
};

enum class MediaKind { kPng, kGif, kY4m, kWav, kWebm, kMp4, kPicture };
std::optional<MediaKind> media_kind(std::string_view name);  // png gif y4m wav webm mp4

bool is_encoded(MediaKind kind);  // whether ffmpeg encodes it, in its own process

// The name of the file, such as NAME.gif, or NAME.png for a single picture. For a folder of PNGs, it is
// NAME/.
std::string file_name(MediaKind kind, const std::string& name);

// `folder` must exist. Throws std::runtime_error.
std::unique_ptr<Media> make_media(MediaKind kind, const std::string& folder, const std::string& name,
                                  const Footage& footage, DiskBudget& budget);

std::unique_ptr<Media> make_png(const std::string& path, const Footage& footage, DiskBudget& budget);
std::unique_ptr<Media> make_gif(const std::string& path, const Footage& footage, DiskBudget& budget);
std::unique_ptr<Media> make_y4m(const std::string& path, const Footage& footage, DiskBudget& budget);
std::unique_ptr<Media> make_wav(const std::string& path, const Footage& footage, DiskBudget& budget);
std::unique_ptr<Media> make_picture(const std::string& path, const Footage& footage, DiskBudget& budget);

std::unique_ptr<Media> make_webm(const std::string& path, const Footage& footage, DiskBudget& budget);
std::unique_ptr<Media> make_mp4(const std::string& path, const Footage& footage, DiskBudget& budget);

}  // namespace racebeam
