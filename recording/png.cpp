// A folder of PNG files, 000000.png and so on: 8-bit palette, no filter.
#include <zlib.h>

#include <cstdio>
#include <stdexcept>
#include <vector>

#include "recording/media.hpp"

namespace racebeam {
namespace {

using Bytes = std::vector<std::uint8_t>;

void put_big_endian(Bytes& out, std::uint32_t number) {
  for (const int shift : {24, 16, 8, 0}) out.push_back(static_cast<std::uint8_t>(number >> shift));
}

void put_chunk(Bytes& out, std::string_view type, std::span<const std::uint8_t> data) {
  put_big_endian(out, static_cast<std::uint32_t>(data.size()));
  const std::size_t checked = out.size();
  out.insert(out.end(), type.begin(), type.end());
  out.insert(out.end(), data.begin(), data.end());
  put_big_endian(out, static_cast<std::uint32_t>(
                          crc32(0, out.data() + checked, static_cast<uInt>(out.size() - checked))));
}

class Pngs final : public Media {
 public:
  Pngs(const std::string& path, const Footage& footage, DiskBudget& budget)
      : folder_(path, budget), height_(footage.height) {
    constexpr std::uint8_t kSignature[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
    head_.assign(std::begin(kSignature), std::end(kSignature));
    Bytes header;
    put_big_endian(header, kPictureWidth);
    put_big_endian(header, static_cast<std::uint32_t>(height_));
    header.insert(header.end(),
                  {8, 3, 0, 0, 0});  // 8 bits, palette; the only compression, filter; no interlace
    put_chunk(head_, "IHDR", header);
    Bytes colors;
    for (const Rgb& color : footage.palette) colors.insert(colors.end(), {color.r, color.g, color.b});
    put_chunk(head_, "PLTE", colors);
  }

  void frame(std::span<const std::uint8_t> pixels) override {
    rows_.clear();
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      if (i % (kPictureWidth / 2) == 0) rows_.push_back(0);  // the row's filter
      rows_.insert(rows_.end(), 2, pixels[i]);
    }
    uLongf size = compressBound(rows_.size());
    packed_.resize(size);
    if (compress2(packed_.data(), &size, rows_.data(), rows_.size(), 3) != Z_OK)
      throw std::runtime_error("cannot compress a picture");
    file_ = head_;
    put_chunk(file_, "IDAT", std::span(packed_).first(size));
    put_chunk(file_, "IEND", {});
    char name[24];
    std::snprintf(name, sizeof name, "%06d.png", number_++);
    folder_.add(name, file_);
  }

  void sound(std::span<const std::uint8_t>) override {}
  void commit() override { folder_.commit(); }

 private:
  AtomicFolder folder_;
  std::size_t height_;
  Bytes head_, rows_, packed_, file_;
  int number_ = 0;
};

}  // namespace

std::unique_ptr<Media> make_png(const std::string& path, const Footage& footage, DiskBudget& budget) {
  return std::make_unique<Pngs>(path, footage, budget);
}

}  // namespace racebeam
