#include "recording/lzw.hpp"

#include <algorithm>

namespace racebeam {

void Lzw::append(std::vector<std::uint8_t>& out, std::span<const std::uint8_t> pixels) {
  packed_.clear();
  bits_ = 0;
  pending_ = 0;
  clear();
  put(kClear);
  if (!pixels.empty()) compress(pixels);
  put(kEnd);
  if (pending_ > 0) packed_.push_back(static_cast<std::uint8_t>(bits_));
  append_blocks(out);
}

void Lzw::compress(std::span<const std::uint8_t> pixels) {
  std::uint32_t prefix = pixels[0];
  for (const std::uint8_t pixel : pixels.subspan(1)) {
    std::uint32_t& code = slot(prefix << 8 | pixel);
    if (code != 0) {
      prefix = code;
      continue;
    }
    put(prefix);
    prefix = pixel;
    if (next_ == kCodes) {
      put(kClear);
      clear();
      continue;
    }
    if (next_ == 1U << width_) ++width_;
    code = next_++;
  }
  put(prefix);
}

void Lzw::append_blocks(std::vector<std::uint8_t>& out) const {
  out.push_back(8);
  for (std::size_t at = 0; at < packed_.size();) {
    const std::size_t size = std::min<std::size_t>(255, packed_.size() - at);
    out.push_back(static_cast<std::uint8_t>(size));
    out.insert(out.end(), packed_.begin() + static_cast<std::ptrdiff_t>(at),
               packed_.begin() + static_cast<std::ptrdiff_t>(at + size));
    at += size;
  }
  out.push_back(0);
}

void Lzw::clear() {
  keys_.fill(0);
  values_.fill(0);
  next_ = kFirst;
  width_ = 9;
}

// The place of a string's code in the hash table, which holds 0 until the string has a code.
std::uint32_t& Lzw::slot(std::uint32_t key) {
  std::size_t at = key * 2654435761U >> 19;
  while (keys_[at] != 0 && keys_[at] != key + 1) at = (at + 1) % kSlots;
  keys_[at] = key + 1;
  return values_[at];
}

void Lzw::put(std::uint32_t code) {
  bits_ |= code << pending_;
  for (pending_ += width_; pending_ >= 8; pending_ -= 8) {
    packed_.push_back(static_cast<std::uint8_t>(bits_));
    bits_ >>= 8;
  }
}

}  // namespace racebeam
