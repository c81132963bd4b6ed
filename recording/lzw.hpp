// The compression of GIF: LZW with codes of 9 to 12 bits, in blocks of up to 255 bytes.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace racebeam {

class Lzw {
 public:
  // Appends the compressed pixels, with the code size before them and the empty block after them.
  void append(std::vector<std::uint8_t>& out, std::span<const std::uint8_t> pixels);

 private:
  static constexpr std::uint32_t kClear = 256, kEnd = 257, kFirst = 258, kCodes = 4096;
  static constexpr std::size_t kSlots = 8192;

  void compress(std::span<const std::uint8_t> pixels);  // at least one
  void append_blocks(std::vector<std::uint8_t>& out) const;
  void clear();
  void put(std::uint32_t code);
  std::uint32_t& slot(std::uint32_t key);

  std::array<std::uint32_t, kSlots> keys_{};    // prefix << 8 | pixel, plus 1; 0: free
  std::array<std::uint32_t, kSlots> values_{};  // the code
  std::uint32_t next_ = kFirst;
  int width_ = 9;
  std::uint32_t bits_ = 0;
  int pending_ = 0;
  std::vector<std::uint8_t> packed_;
};

}  // namespace racebeam
