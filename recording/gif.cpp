// An animated GIF. It has every second frame, because its clock ticks in hundredths of a second.
#include <initializer_list>
#include <vector>

#include "recording/lzw.hpp"
#include "recording/media.hpp"

namespace racebeam {
namespace {

using Bytes = std::vector<std::uint8_t>;

void put_word(Bytes& out, std::size_t number) {
  out.push_back(static_cast<std::uint8_t>(number));
  out.push_back(static_cast<std::uint8_t>(number >> 8));
}

// Replaces `insert`, about which g++ 12 warns without cause.
void put(Bytes& out, std::initializer_list<int> bytes) {
  for (const int byte : bytes) out.push_back(static_cast<std::uint8_t>(byte));
}

void put_text(Bytes& out, std::string_view text) {
  for (const char c : text) out.push_back(static_cast<std::uint8_t>(c));
}

class Gif final : public Media {
 public:
  Gif(const std::string& path, const Footage& footage, DiskBudget& budget)
      : file_(path, budget, ";"), height_(footage.height), rate_(footage.rate) {
    Bytes head;
    put_text(head, "GIF89a");
    put_word(head, kPictureWidth);
    put_word(head, height_);
    put(head, {0xF7, 0, 0});  // a palette of 256 colours, 8 bits each
    for (const Rgb& color : footage.palette) put(head, {color.r, color.g, color.b});
    put_text(head, "\x21\xFF\x0BNETSCAPE2.0");
    put(head, {3, 1, 0, 0, 0});  // repeats for ever
    file_.write(head);
  }

  void frame(std::span<const std::uint8_t> pixels) override {
    if (frames_++ % kEvery != 0) return;
    wide_.clear();
    for (const std::uint8_t pixel : pixels) wide_.insert(wide_.end(), 2, pixel);
    block_.clear();
    put(block_, {0x21, 0xF9, 4, 0});  // the next image is shown for:
    put_word(block_, delay());
    put(block_, {0, 0, 0x2C, 0, 0, 0, 0});
    put_word(block_, kPictureWidth);
    put_word(block_, height_);
    block_.push_back(0);
    lzw_.append(block_, wide_);
    file_.write(block_);
  }

  void sound(std::span<const std::uint8_t>) override {}

  void commit() override { file_.commit(); }

 private:
  static constexpr int kEvery = 2;

  // The delay of the next image, in hundredths of a second. Rounding errors do not add up.
  std::size_t delay() {
    const auto time = [this](int frames) { return (frames * kEvery * 100 + rate_ / 2) / rate_; };
    const int number = number_++;
    return static_cast<std::size_t>(time(number + 1) - time(number));
  }

  AtomicFile file_;
  std::size_t height_;
  int rate_;
  Lzw lzw_;
  Bytes wide_, block_;
  int frames_ = 0, number_ = 0;
};

}  // namespace

std::unique_ptr<Media> make_gif(const std::string& path, const Footage& footage, DiskBudget& budget) {
  return std::make_unique<Gif>(path, footage, budget);
}

}  // namespace racebeam
