#include "recording/png.hpp"

#include <zlib.h>

#include <cstdio>
#include <stdexcept>
#include <string_view>
#include <utility>

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

// A folder of pictures, 000000.png and so on.
class Pngs final : public Media {
 public:
  Pngs(const std::string& path, const Footage& footage, DiskBudget& budget)
      : budget_(budget), folder_(path, budget), writer_(footage) {}

  void frame(std::span<const std::uint8_t> pixels) override {
    const auto file = writer_.file(pixels);
    char name[24];
    std::snprintf(name, sizeof name, "%06d.png", number_);
    budget_.take(kBytesBesideFile);
    beside_ += kBytesBesideFile;
    folder_.add(name, file);
    ++number_;
  }

  void sound(std::span<const std::uint8_t>) override {}

  void commit() override {
    folder_.commit();
    budget_.give_back(std::exchange(beside_, 0));  // the result says how long the files are
  }

 private:
  DiskBudget& budget_;
  std::size_t beside_ = 0;  // bytes that were charged in addition to those of the files
  AtomicFolder folder_;
  PngWriter writer_;
  int number_ = 0;
};

// A file with a single picture.
class Picture final : public Media {
 public:
  Picture(const std::string& path, const Footage& footage, DiskBudget& budget)
      : file_(path, budget), writer_(footage) {}

  void frame(std::span<const std::uint8_t> pixels) override {
    file_.write(writer_.file(pixels));
    written_ = true;
  }

  void sound(std::span<const std::uint8_t>) override {}
  void commit() override {
    if (!written_) throw std::runtime_error("the picture is longer than a recording may be");
    file_.commit();
  }

 private:
  AtomicFile file_;
  PngWriter writer_;
  bool written_ = false;
};

}  // namespace

PngWriter::PngWriter(const Footage& footage) {
  constexpr std::uint8_t kSignature[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  head_.assign(std::begin(kSignature), std::end(kSignature));
  Bytes header;
  put_big_endian(header, kPictureWidth);
  put_big_endian(header, static_cast<std::uint32_t>(footage.height));
  // 8 bits, palette, the only method of compression, the only one of filters, no interlace
  header.insert(header.end(), {8, 3, 0, 0, 0});
  put_chunk(head_, "IHDR", header);
  Bytes colors;
  for (const Rgb& color : footage.palette) colors.insert(colors.end(), {color.r, color.g, color.b});
  put_chunk(head_, "PLTE", colors);
}

std::span<const std::uint8_t> PngWriter::file(std::span<const std::uint8_t> pixels) {
  rows_.clear();
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (i % (kPictureWidth / 2) == 0) rows_.push_back(0);  // the row's filter
    rows_.insert(rows_.end(), 2, pixels[i]);
  }
  uLongf size = compressBound(static_cast<uLong>(rows_.size()));
  packed_.resize(size);
  if (compress2(packed_.data(), &size, rows_.data(), static_cast<uLong>(rows_.size()), 3) != Z_OK)
    throw std::runtime_error("cannot compress a picture");
  file_ = head_;
  put_chunk(file_, "IDAT", std::span(packed_).first(size));
  put_chunk(file_, "IEND", {});
  return file_;
}

std::unique_ptr<Media> make_png(const std::string& path, const Footage& footage, DiskBudget& budget) {
  return std::make_unique<Pngs>(path, footage, budget);
}

std::unique_ptr<Media> make_picture(const std::string& path, const Footage& footage, DiskBudget& budget) {
  return std::make_unique<Picture>(path, footage, budget);
}

}  // namespace racebeam
