#include "environment/observe/preprocess.hpp"

#include <algorithm>
#include <cstring>
#include <map>
#include <mutex>
#include <tuple>

#include "environment/environment.hpp"
#include "system/invalid_input.hpp"

namespace racebeam {
namespace {

constexpr std::size_t kRow = kScreenWidth;

bool same_row(const std::uint8_t* a, const std::uint8_t* b) { return std::memcmp(a, b, kRow) == 0; }

// Eight pixels of each picture, and the eight bytes of the plane that they give.
template <std::size_t pictures>
struct Octet {
  std::array<std::uint64_t, pictures> pixels{};
  std::uint64_t bytes = 0;
};

// A row that equals the row above is copied, and so is a group of eight pixels that equals the last group.
// Both are common, since most of a row is background.
template <std::size_t pictures>
void make_rows(const std::array<const std::uint8_t*, pictures>& in, const BrightnessTable& table,
               RowFlags stale, std::span<std::uint8_t> plane) {
  const auto same_as_above = [&in](std::size_t at) {
    return std::ranges::all_of(
        in, [at](const std::uint8_t* picture) { return same_row(picture + at, picture + at - kRow); });
  };
  const auto brightest = [&](std::size_t at) {
    std::uint8_t most = table[in[0][at]];
    if constexpr (pictures == 2) most = std::max(most, table[in[1][at]]);
    return most;
  };
  Octet<pictures> last;
  for (std::size_t i = 0; i < 8; ++i) last.bytes = last.bytes << 8 | table[0];
  for (std::size_t at = 0; at < plane.size(); at += kRow) {
    if (stale[at / kRow] == 0) continue;
    if (at > 0 && same_as_above(at)) {
      std::memcpy(&plane[at], &plane[at - kRow], kRow);
      continue;
    }
    for (std::size_t x = at; x < at + kRow; x += 8) {
      Octet<pictures> octet;
      for (std::size_t i = 0; i < pictures; ++i) std::memcpy(&octet.pixels[i], in[i] + x, 8);
      if (octet.pixels != last.pixels) {
        std::array<std::uint8_t, 8> bytes;
        for (std::size_t i = 0; i < 8; ++i) bytes[i] = brightest(x + i);
        std::memcpy(&octet.bytes, bytes.data(), 8);
        last = octet;
      }
      std::memcpy(&plane[x], &last.bytes, 8);
    }
  }
}

std::array<BrightnessTable, 3> make_colour_tables(Format format) {
  std::array<BrightnessTable, 3> tables{};
  const Palette& colours = palette(format);
  for (std::size_t i = 0; i < colours.size(); ++i) {
    tables[0][i] = colours[i].r;
    tables[1][i] = colours[i].g;
    tables[2][i] = colours[i].b;
  }
  return tables;
}

}  // namespace

const std::array<BrightnessTable, 3>& colour_tables(Format format) {
  static const std::array<std::array<BrightnessTable, 3>, 4> all = {
      make_colour_tables(Format::kNtsc), make_colour_tables(Format::kPal), make_colour_tables(Format::kPal60),
      make_colour_tables(Format::kSecam)};
  switch (format) {
    case Format::kPal: return all[1];
    case Format::kPal60: return all[2];
    case Format::kSecam: return all[3];
    default: return all[0];
  }
}

void make_plane(std::span<const std::uint8_t> screen, const BrightnessTable& table, RowFlags stale,
                std::span<std::uint8_t> plane) {
  make_rows<1>({screen.data()}, table, stale, plane);
}

void make_brighter_plane(std::span<const std::uint8_t> screen, std::span<const std::uint8_t> previous,
                         const BrightnessTable& table, RowFlags stale, std::span<std::uint8_t> plane) {
  make_rows<2>({screen.data(), previous.data()}, table, stale, plane);
}

const ScreenResize& screen_resize(int height, int to_width, int to_height) {
  static std::mutex mutex;
  static std::map<std::tuple<int, int, int>, ScreenResize> all;
  const std::lock_guard lock(mutex);
  const std::tuple key(height, to_width, to_height);
  const auto found = all.find(key);
  if (found != all.end()) return found->second;
  if (to_width > kScreenWidth || to_height > height)
    return all.emplace(key, Enlargement(kScreenWidth, height, to_width, to_height)).first->second;
  return all.emplace(key, AreaResize(kScreenWidth, height, to_width, to_height)).first->second;
}

}  // namespace racebeam
