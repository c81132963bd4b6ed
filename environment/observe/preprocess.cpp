#include "environment/observe/preprocess.hpp"

#include <algorithm>
#include <cstring>
#include <map>
#include <mutex>

namespace racebeam {
namespace {

constexpr std::size_t kRow = kScreenWidth;

bool same_row(const std::uint8_t* a, const std::uint8_t* b) { return std::memcmp(a, b, kRow) == 0; }

// Rows that repeat are common: they are copied.
template <typename Same, typename Make>
void make_rows(std::span<std::uint8_t> grey, Same same_as_above, Make make_row) {
  for (std::size_t at = 0; at < grey.size(); at += kRow) {
    if (at > 0 && same_as_above(at)) {
      std::memcpy(&grey[at], &grey[at - kRow], kRow);
    } else {
      make_row(at);
    }
  }
}

}  // namespace

void make_grey(std::span<const std::uint8_t> screen, const GreyTable& table, std::span<std::uint8_t> grey) {
  const std::uint8_t* const in = screen.data();
  make_rows(
      grey, [&](std::size_t at) { return same_row(in + at, in + at - kRow); },
      [&](std::size_t at) {
        for (std::size_t x = at; x < at + kRow; ++x) grey[x] = table[in[x]];
      });
}

void make_brighter_grey(std::span<const std::uint8_t> screen, std::span<const std::uint8_t> previous,
                        const GreyTable& table, std::span<std::uint8_t> grey) {
  const std::uint8_t *const a = screen.data(), *const b = previous.data();
  make_rows(
      grey,
      [&](std::size_t at) { return same_row(a + at, a + at - kRow) && same_row(b + at, b + at - kRow); },
      [&](std::size_t at) {
        for (std::size_t x = at; x < at + kRow; ++x) grey[x] = std::max(table[a[x]], table[b[x]]);
      });
}

const AreaResize& small_screen_maker(int height) {
  static std::mutex mutex;
  static std::map<int, AreaResize> all;
  const std::lock_guard lock(mutex);
  return all.try_emplace(height, kScreenWidth, height, kSmallSide, kSmallSide).first->second;
}

SmallScreens::SmallScreens(int depth, int height)
    : resize_(&small_screen_maker(height)),
      bytes_(static_cast<std::size_t>(depth) * kSmallSize) {}

void SmallScreens::clear() { std::ranges::fill(bytes_, std::uint8_t{0}); }

void SmallScreens::push(const Environment& environment, bool pooled) {
  const auto screen = environment.screen();
  const GreyTable& table = grey_table(environment.format());
  grey_.resize(screen.size());
  pooled ? make_brighter_grey(screen, environment.previous_screen(), table, grey_)
         : make_grey(screen, table, grey_);
  std::shift_left(bytes_.begin(), bytes_.end(), kSmallSize);
  (*resize_)(grey_, std::span(bytes_).last(kSmallSize));
}

void SmallScreens::set_bytes(std::span<const std::uint8_t> bytes) {
  std::ranges::copy(bytes, bytes_.begin());
}

}  // namespace racebeam
