#include "environment/observe/screen_stack.hpp"

#include <algorithm>
#include <string>

#include "system/invalid_input.hpp"

namespace racebeam {
namespace {

constexpr int kLeastHeight = 9;  // AreaResize makes the tallest screen no lower
constexpr int kMostGrowth = 2;

int checked(int size, int least, int own, const std::string& what) {
  const int most = kMostGrowth * own;
  if (size == 0) return own;
  if (size >= least && size <= most) return size;
  throw InvalidInput("the " + what + " of an observation is " + std::to_string(size) + "; it takes " +
                     std::to_string(least) + " to " + std::to_string(most) + ", or 0 for the screen's own");
}

}  // namespace

ScreenStack::ScreenStack(const StackSettings& settings, const Environment& environment)
    : settings_(settings), resize_(nullptr) {
  const bool is_cut = settings.rows > 0 && settings.rows < environment.height();
  const int rows = is_cut ? settings.rows : environment.height();
  const int width = checked(settings.width, 1, kScreenWidth, "width");
  const int height = checked(settings.height, kLeastHeight, rows, "height");
  settings_.width = width;
  settings_.height = height;
  if (!is_cut) settings_.rows = 0;
  if (width != kScreenWidth || height != rows) resize_ = &screen_resize(rows, width, height);
  plane_size_ = static_cast<std::size_t>(rows) * kScreenWidth;
  if (settings.rgb) {
    tables_ = colour_tables(environment.format());
  } else {
    tables_ = std::span(&grey_table(environment.format()), 1);
  }
  const std::size_t reduced = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  screen_size_ = reduced * tables_.size();
  seen_.resize(plane_size_ * tables_.size());
  if (tables_.size() > 1) reduced_.resize(reduced);
  screens_.resize(screen_size_ * static_cast<std::size_t>(depth()));
}

void ScreenStack::clear() { std::ranges::fill(screens_, std::uint8_t{0}); }

void ScreenStack::look(const Environment& environment, bool pooled) {
  const auto screen = environment.screen().first(plane_size_);
  for (std::size_t channel = 0; channel < tables_.size(); ++channel) {
    if (pooled) {
      make_brighter_plane(screen, environment.previous_screen().first(plane_size_), tables_[channel],
                          plane(channel));
    } else {
      make_plane(screen, tables_[channel], plane(channel));
    }
  }
}

void ScreenStack::look_at_previous(const Environment& environment) {
  const auto before = environment.previous_screen();
  for (std::size_t channel = 0; channel < tables_.size(); ++channel) {
    const auto seen = plane(channel);
    for (std::size_t i = 0; i < seen.size(); ++i) seen[i] = std::max(seen[i], tables_[channel][before[i]]);
  }
}

void ScreenStack::reduce(std::size_t channel, std::span<std::uint8_t> to) {
  const auto run = [&](const auto& resize) { resize(plane(channel), to); };
  if (resize_ != nullptr) return std::visit(run, *resize_);
  std::ranges::copy(plane(channel), to.begin());
}

void ScreenStack::push() {
  if (++newest_ == static_cast<std::size_t>(depth())) newest_ = 0;
  if (tables_.size() == 1) return reduce(0, newest());
  for (std::size_t channel = 0; channel < tables_.size(); ++channel) {
    reduce(channel, reduced_);
    std::uint8_t* to = newest().data() + channel;
    for (const std::uint8_t value : reduced_) {
      *to = value;
      to += tables_.size();
    }
  }
}

void ScreenStack::repeat() {
  for (std::size_t at = 0; at < screens_.size(); at += screen_size_) {
    if (at != newest_ * screen_size_) std::ranges::copy(newest(), &screens_[at]);
  }
}

void ScreenStack::copy_to(std::span<std::uint8_t> to, std::size_t stride) const {
  std::size_t from = newest_;
  for (std::size_t at = 0; at < to.size(); at += stride) {
    if (++from == static_cast<std::size_t>(depth())) from = 0;
    std::ranges::copy(std::span(screens_).subspan(from * screen_size_, screen_size_), &to[at]);
  }
}

std::vector<std::uint8_t> ScreenStack::bytes() const {
  std::vector<std::uint8_t> all(size());
  copy_to(all);
  return all;
}

void ScreenStack::set_bytes(std::span<const std::uint8_t> bytes) {
  std::ranges::copy(bytes, screens_.begin());
  newest_ = static_cast<std::size_t>(depth()) - 1;
}

}  // namespace racebeam
