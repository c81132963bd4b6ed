// Bytes as hexadecimal digits: with AVX2 32 at a time, with NEON 16, elsewhere by a table.
#include "protocol/encoding/text.hpp"
#include "protocol/encoding/text_forms.hpp"

namespace racebeam {
namespace {

void write_hex(char* to, const std::uint8_t* bytes, std::size_t count, [[maybe_unused]] Simd form) {
  if constexpr (kHasAvx) {
    if (form >= Simd::kAvx2) return write_hex_avx2(to, bytes, count);
  }
  if constexpr (kHasNeon) {
    if (form == Simd::kNeon) return write_hex_neon(to, bytes, count);
  }
  write_hex_plain(to, bytes, count);
}

}  // namespace

void append_hex(std::string& out, std::span<const std::uint8_t> bytes, Simd form) {
  const std::size_t start = out.size();
  out.resize(start + 2 * bytes.size());
  write_hex(out.data() + start, bytes.data(), bytes.size(), form);
}

}  // namespace racebeam
