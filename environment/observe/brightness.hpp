// Converts rows of palette indices to brightness, one row or the brighter pixels of two, in a variant for
// each kind of processor.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "emulator/base/simd.hpp"
#include "emulator/tia/palette.hpp"

namespace racebeam {

// The brightness of each palette index: a grey_table(), or one of colour_tables().
using BrightnessTable = GreyTable;

class Brightness {
 public:
  // `table` must outlive it. Simd::kAvx512 has its own form only with AVX512_VBMI (has_vbmi()); without that,
  // it is as kAvx2.
  explicit Brightness(const BrightnessTable& table, Simd form = simd());

  std::uint8_t of(std::uint8_t pixel) const { return (*table_)[pixel]; }
  // Each reads 160 palette indices, and writes 160 bytes.
  void make_row(const std::uint8_t* pixels, std::uint8_t* to) const { make_(*this, {pixels}, to); }
  void make_brighter_row(const std::uint8_t* one, const std::uint8_t* other, std::uint8_t* to) const {
    make_brighter_(*this, {one, other}, to);
  }

 private:
  struct Plain;  // brightness_plain.hpp; the others: brightness_x86.cpp, brightness_neon.cpp
  struct X86;
  struct Neon;
  template <std::size_t pictures>
  using Rows = std::array<const std::uint8_t*, pictures>;
  template <std::size_t pictures>
  using Make = void (*)(const Brightness&, const Rows<pictures>& rows, std::uint8_t* to);

  void use_x86(Simd form);
  void make_steps();
  void use_neon();

  const BrightnessTable* table_;
  Make<1> make_;
  Make<2> make_brighter_;
  // For AVX2: the even entries of the table, by 16. All but the first 16 are differences (XOR) from those
  // before.
  alignas(16) std::array<std::array<std::uint8_t, 16>, 8> steps_{};
};

}  // namespace racebeam
