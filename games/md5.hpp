// MD5 (RFC 1321), by which images are identified.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

namespace racebeam {

// The sum of all bytes that were added.
class Md5 {
 public:
  void add(std::span<const std::uint8_t> bytes);
  std::string hex() const;  // in lower case

 private:
  static constexpr std::size_t kBlock = 64;

  void add_block(const std::uint8_t* block);

  std::array<std::uint32_t, 4> state_ = {0x67452301, 0xEFCDAB89, 0x98BADCFE, 0x10325476};
  std::array<std::uint8_t, kBlock> block_{};  // the last bytes, until they are a whole block
  std::uint64_t length_ = 0;                  // bytes so far
};

std::string md5_of(std::span<const std::uint8_t> bytes);  // hex() of these bytes

}  // namespace racebeam
