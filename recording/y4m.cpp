// Y4M for video encoders: every frame, uncompressed, 4:4:4. Colours are those of ITU-R BT.601, in studio
// swing.
#include <array>
#include <cmath>
#include <vector>

#include "recording/media.hpp"

namespace racebeam {
namespace {

using Yuv = std::array<std::uint8_t, 3>;

Yuv yuv_of(const Rgb& color) {
  const double r = color.r / 255.0, g = color.g / 255.0, b = color.b / 255.0;
  const double y = 16 + 65.481 * r + 128.553 * g + 24.966 * b;
  const double u = 128 - 37.797 * r - 74.203 * g + 112.0 * b;
  const double v = 128 + 112.0 * r - 93.786 * g - 18.214 * b;
  const auto rounded = [](double value) { return static_cast<std::uint8_t>(std::lround(value)); };
  return {rounded(y), rounded(u), rounded(v)};
}

constexpr std::string_view kFrameHead = "FRAME\n";

class Y4m final : public Media {
 public:
  Y4m(const std::string& path, const Footage& footage, DiskBudget& budget) : file_(path, budget) {
    for (std::size_t i = 0; i < colors_.size(); ++i) colors_[i] = yuv_of(footage.palette[i]);
    file_.write("YUV4MPEG2 W" + std::to_string(kPictureWidth) + " H" + std::to_string(footage.height) + " F" +
                std::to_string(footage.rate) + ":1 Ip A1:1 C444\n");
  }

  void frame(std::span<const std::uint8_t> pixels) override {
    planes_.assign(kFrameHead.begin(), kFrameHead.end());
    for (std::size_t plane = 0; plane < 3; ++plane) {
      for (const std::uint8_t pixel : pixels) planes_.insert(planes_.end(), 2, colors_[pixel][plane]);
    }
    file_.write(planes_);
  }

  void sound(std::span<const std::uint8_t>) override {}
  void commit() override { file_.commit(); }

 private:
  AtomicFile file_;
  std::array<Yuv, 256> colors_;
  std::vector<std::uint8_t> planes_;  // the planes of a frame, after its header
};

}  // namespace

std::unique_ptr<Media> make_y4m(const std::string& path, const Footage& footage, DiskBudget& budget) {
  return std::make_unique<Y4m>(path, footage, budget);
}

}  // namespace racebeam
