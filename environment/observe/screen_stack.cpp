#include "environment/observe/screen_stack.hpp"

#include <algorithm>
#include <cstring>
#include <string>

#include "emulator/tia/line_cache/line_record.hpp"
#include "system/invalid_input.hpp"

namespace racebeam {
namespace {

constexpr int kMinHeight = 9;  // AreaResize makes the tallest screen no lower
constexpr int kMaxGrowth = 2;

// Whether a way to resize makes single rows, and finds those that depend on others.
template <typename Resize>
constexpr bool knows_rows = requires(const Resize& resize, std::span<const std::uint8_t> changed,
                                     std::span<std::uint8_t> rows) {
  resize.depending(changed, rows);
};

int checked(int size, int least, int own, const std::string& what) {
  const int most = kMaxGrowth * own;
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
  const int height = checked(settings.height, kMinHeight, rows, "height");
  settings_.width = width;
  settings_.height = height;
  if (!is_cut) settings_.rows = 0;
  if (width != kScreenWidth || height != rows) resize_ = &screen_resize(rows, width, height);
  plane_size_ = static_cast<std::size_t>(rows) * kScreenWidth;
  if (settings.rgb) {
    for (const BrightnessTable& table : colour_tables(environment.format())) brightness_.emplace_back(table);
  } else {
    brightness_.emplace_back(grey_table(environment.format()));
  }
  const std::size_t reduced = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  screen_size_ = reduced * brightness_.size();
  seen_.resize(plane_size_ * brightness_.size());
  sources_.resize(static_cast<std::size_t>(rows));
  stale_.resize(sources_.size());
  changed_.resize(sources_.size(), 1);
  due_rows_.resize(static_cast<std::size_t>(height));
  if (brightness_.size() > 1) reduced_.resize(reduced);
  screens_.resize(screen_size_ * static_cast<std::size_t>(depth()));
}

void ScreenStack::clear() {
  std::ranges::fill(screens_, std::uint8_t{0});
  mark_all_changed();
}

void ScreenStack::mark_all_changed() { std::ranges::fill(changed_, std::uint8_t{1}); }

// Without branches: which rows are stale cannot be foreseen.
void ScreenStack::find_stale(const Environment& environment, bool pooled) {
  const auto lines = environment.screen_lines();
  const auto others = pooled ? environment.previous_screen_lines() : lines;
  const bool has_both = !lines.empty() && !others.empty();
  const std::span stale(stale_), changed(changed_);
  for (std::size_t row = 0; Source & source : sources_) {
    Source now;
    if (has_both) now = {std::min(lines[row], others[row]), std::max(lines[row], others[row])};
    const bool unknown = now.one <= kAnyLine;
    stale[row] = static_cast<std::uint8_t>(unknown | (now.one != source.one) | (now.other != source.other));
    changed[row] |= stale[row];
    source = now;
    ++row;
  }
}

void ScreenStack::look(const Environment& environment, bool pooled) {
  const auto screen = environment.screen().first(plane_size_);
  find_stale(environment, pooled);
  for (std::size_t channel = 0; channel < brightness_.size(); ++channel) {
    if (pooled) {
      make_brighter_plane(screen, environment.previous_screen().first(plane_size_), brightness_[channel],
                          stale_, plane(channel));
    } else {
      make_plane(screen, brightness_[channel], stale_, plane(channel));
    }
  }
}

void ScreenStack::pool_with_previous(const Environment& environment) {
  const auto before = environment.previous_screen();
  std::ranges::fill(sources_, Source{});
  mark_all_changed();
  for (std::size_t channel = 0; channel < brightness_.size(); ++channel) {
    const auto pixels = plane(channel);
    for (std::size_t i = 0; i < pixels.size(); ++i)
      pixels[i] = std::max(pixels[i], brightness_[channel].of(before[i]));
  }
}

void ScreenStack::reduce(std::size_t channel, std::span<std::uint8_t> to) {
  if (resize_ == nullptr) {
    std::ranges::copy(plane(channel), to.begin());
  } else {
    const auto pixels = plane(channel);
    std::visit(
        [&](const auto& resize) {
          if constexpr (knows_rows<decltype(resize)>)
            resize(pixels, to, due_rows_);
          else
            resize(pixels, to);
        },
        *resize_);
  }
}

void ScreenStack::find_due_rows() {
  const auto find = [this](const auto& resize) {
    if constexpr (knows_rows<decltype(resize)>) resize.depending(changed_, due_rows_);
    return knows_rows<decltype(resize)>;
  };
  if (resize_ != nullptr && std::visit(find, *resize_)) return;
  const bool changed = std::ranges::find(changed_, 1) != changed_.end();
  std::ranges::fill(due_rows_, static_cast<std::uint8_t>(changed));
}

void ScreenStack::push() {
  const auto before = newest();
  if (++newest_ == static_cast<std::size_t>(depth())) newest_ = 0;
  find_due_rows();
  std::ranges::fill(changed_, std::uint8_t{0});
  if (std::ranges::find(due_rows_, 1) != due_rows_.end()) make_newest();
  if (depth() == 1) return;
  const std::size_t row = screen_size_ / due_rows_.size();
  for (std::size_t y = 0; y < due_rows_.size(); ++y) {
    if (due_rows_[y] == 0) std::ranges::copy(before.subspan(y * row, row), &newest()[y * row]);
  }
}

void ScreenStack::make_newest() {
  if (brightness_.size() == 1) return reduce(0, newest());
  for (std::size_t channel = 0; channel < brightness_.size(); ++channel) {
    reduce(channel, reduced_);
    const std::size_t width = reduced_.size() / due_rows_.size();
    for (std::size_t at = 0; at < reduced_.size(); ++at) {
      if (due_rows_[at / width] != 0) newest()[at * brightness_.size() + channel] = reduced_[at];
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
    std::memcpy(&to[at], &screens_[from * screen_size_], screen_size_);
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
  mark_all_changed();
}

}  // namespace racebeam
