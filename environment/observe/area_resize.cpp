#include "environment/observe/area_resize.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "environment/observe/area_resize_rows.hpp"

namespace racebeam {
namespace {

constexpr int kMaxShrinking = static_cast<int>(kSlots) - 3;

void check(int width, int height, int to_width, int to_height) {
  if (to_width > 0 && to_height > 0 && to_width <= width && to_height <= height &&
      to_width <= static_cast<int>(AreaResize::kWidest) && height / to_height <= kMaxShrinking) {
    return;
  }
  throw std::invalid_argument("a picture of " + std::to_string(width) + " x " + std::to_string(height) +
                              " can't be made " + std::to_string(to_width) + " x " +
                              std::to_string(to_height) + "; it can shrink, to a width of at most " +
                              std::to_string(AreaResize::kWidest) + " and to one " +
                              std::to_string(kMaxShrinking) + "th of its height");
}

}  // namespace

// A source cell of which a target covers less than a thousandth is left out, as in OpenCV. Weights of zero,
// which change no sum, give all targets the same number of taps.
AreaAxis::AreaAxis(int cells, int targets)
    : taps(std::min(static_cast<std::size_t>(cells / targets) + 2, static_cast<std::size_t>(cells))),
      weights(static_cast<std::size_t>(targets) * taps) {
  constexpr double kSliver = 1e-3;
  const double scale = static_cast<double>(cells) / targets;
  const std::size_t last_first = static_cast<std::size_t>(cells) - taps;
  for (int target = 0; target < targets; ++target) {
    const double begin = target * scale, end = begin + scale;
    const double covered = std::min(scale, cells - begin);
    const int whole_end = std::min(static_cast<int>(std::floor(end)), cells - 1);
    const int whole_begin = std::min(static_cast<int>(std::ceil(begin)), whole_end);
    const bool sliver_before = whole_begin - begin > kSliver;
    first.push_back(std::min(static_cast<std::size_t>(whole_begin - sliver_before), last_first));
    const auto add = [&](int cell, double weight) {
      weights[first.size() * taps - taps + static_cast<std::size_t>(cell) - first.back()] =
          static_cast<float>(weight / covered);
    };
    if (sliver_before) add(whole_begin - 1, whole_begin - begin);
    for (int cell = whole_begin; cell < whole_end; ++cell) add(cell, 1);
    if (end - whole_end > kSliver) add(whole_end, std::min({end - whole_end, 1.0, covered}));
  }
}

AreaResize::AreaResize(int width, int height, int to_width, int to_height, Simd form)
    : width_((check(width, height, to_width, to_height), static_cast<std::size_t>(width))),
      columns_(width, to_width),
      rows_(height, to_height) {
  if (form != Simd::kPlain && fits_octets()) make_octets();
}

// The taps of four targets must be within 16 bytes of a row.
bool AreaResize::fits_octets() const {
  if (width_ < 16) return false;
  for (std::size_t target = 0; target < columns_.first.size(); target += 4) {
    const std::size_t last = std::min(target + 3, columns_.first.size() - 1);
    if (columns_.first[last] + columns_.taps - columns_.first[target] > 16) return false;
  }
  return true;
}

void AreaResize::make_octets() {
  const std::size_t targets = columns_.first.size();
  for (std::size_t first = 0; first < targets; first += 8) {
    Octet octet{{}, {}, {}};
    for (std::size_t half = 0; half < 2; ++half)
      octet.from[half] = std::min(columns_.first[std::min(first + 4 * half, targets - 1)], width_ - 16);
    for (std::size_t tap = 0; tap < columns_.taps; ++tap) {
      octet.places.emplace_back().fill(0x80);  // selects zero
      octet.weights.emplace_back().fill(0);
      for (std::size_t lane = 0; lane < std::min<std::size_t>(8, targets - first); ++lane) {
        const std::size_t target = first + lane;
        octet.places[tap][4 * lane] =
            static_cast<std::uint8_t>(columns_.first[target] + tap - octet.from[lane / 4]);
        octet.weights[tap][lane] = columns_.weights[target * columns_.taps + tap];
      }
    }
    octets_.push_back(std::move(octet));
  }
}

void AreaResize::reduce_plain(const std::uint8_t* row, float* to) const {
  const float* weight = columns_.weights.data();
  for (std::size_t x = 0; x < columns_.first.size(); ++x) {
    const std::uint8_t* const cells = row + columns_.first[x];
    float sum = 0;
    for (std::size_t tap = 0; tap < columns_.taps; ++tap) sum += static_cast<float>(cells[tap]) * *weight++;
    to[x] = sum;
  }
}

void AreaResize::depending(std::span<const std::uint8_t> changed, std::span<std::uint8_t> rows) const {
  for (std::size_t y = 0; y < rows_.first.size(); ++y) {
    const auto sources = changed.subspan(rows_.first[y], rows_.taps);
    rows[y] = std::ranges::any_of(sources, [](std::uint8_t flag) { return flag != 0; }) ? 1 : 0;
  }
}

void AreaResize::run_plain(const std::uint8_t* in, std::uint8_t* out,
                           std::span<const std::uint8_t> rows) const {
  run(in, out, rows, [this](const std::uint8_t* row, float* to) { reduce_plain(row, to); });
}

void AreaResize::operator()(std::span<const std::uint8_t> in, std::span<std::uint8_t> out,
                            std::span<const std::uint8_t> rows) const {
  if constexpr (kHasAvx) {
    if (!octets_.empty()) return run_avx2(in.data(), out.data(), rows);
  }
  if constexpr (kHasNeon) {
    if (!octets_.empty()) return run_neon(in.data(), out.data(), rows);
  }
  run_plain(in.data(), out.data(), rows);
}

}  // namespace racebeam
