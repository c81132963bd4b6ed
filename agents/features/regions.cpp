#include "agents/features/regions.hpp"

#include <algorithm>
#include <cstring>

namespace racebeam {
namespace {

constexpr std::uint32_t kNoRegion = 0xFFFFFFFF;
constexpr std::uint8_t kNoLowestBit = 0xFE;

bool equal_words(const std::uint8_t* a, const std::uint8_t* b) {
  constexpr std::uint64_t kNoLowestBits = 0xFEFEFEFEFEFEFEFE;
  std::uint64_t first, second;
  std::memcpy(&first, a, sizeof first);
  std::memcpy(&second, b, sizeof second);
  return ((first ^ second) & kNoLowestBits) == 0;
}

}  // namespace

Regions::Regions(const Background& background) {
  for (std::size_t pixel = 0; pixel < background.size(); ++pixel)
    behind_[pixel] = static_cast<std::uint8_t>(background[pixel] << 1);
}

void Regions::find(Screen screen) {
  runs_.clear();
  colours_.clear();
  parent_.clear();
  touching_.clear();
  Number above = 0;
  for (std::uint8_t row = 0; row < kFeatureHeight; ++row) {
    const std::size_t pixel = std::size_t{row} * kFeatureWidth;
    const auto first = static_cast<Number>(runs_.size());
    scan_row(screen.data() + pixel, behind_.data() + pixel, row);
    connect_rows(above, first);
    above = first;
  }
  gather();
}

// Most pixels are the background's: they are passed over eight at a time.
void Regions::scan_row(const std::uint8_t* pixels, const std::uint8_t* behind, std::uint8_t row) {
  for (std::uint8_t word = 0; word < kFeatureWidth; word += 8) {
    if (equal_words(pixels + word, behind + word)) continue;
    for (std::uint8_t column = word; column < word + 8; ++column) {
      const std::uint8_t index = pixels[column] & kNoLowestBit;
      if (index != behind[column]) add_pixel(row, column, index);
    }
  }
}

void Regions::add_pixel(std::uint8_t row, std::uint8_t column, std::uint8_t colour) {
  if (!runs_.empty() && runs_.back().row == row && runs_.back().last + 1 == column &&
      colours_.back() == colour) {
    runs_.back().last = column;
    return;
  }
  parent_.push_back(static_cast<Number>(runs_.size()));
  runs_.push_back({row, column, column});
  colours_.push_back(colour);
}

// Connects the last row, whose runs begin with `row`, in itself and with the one above it, from `above` on.
void Regions::connect_rows(Number above, Number row) {
  Number left = above;  // the first run above that is not wholly to the left
  for (Number run = row; run < runs_.size(); ++run) {
    const PixelRun& here = runs_[run];
    if (run > row && runs_[run - 1].last + 1 == here.first) touching_.emplace_back(run - 1, run);
    while (left < row && (runs_[left].row + 1 < here.row || runs_[left].last + 1 < here.first)) ++left;
    for (Number other = left; other < row && runs_[other].first <= here.last + 1; ++other)
      colours_[other] == colours_[run] ? connect(other, run) : void(touching_.emplace_back(other, run));
  }
}

void Regions::connect(Number run, Number other) {
  const Number a = root(run), b = root(other);
  parent_[std::max(a, b)] = std::min(a, b);
}

Regions::Number Regions::root(Number run) {
  while (parent_[run] != run) run = parent_[run] = parent_[parent_[run]];
  return run;
}

void Regions::gather() {
  measure();
  leave_out_single_pixels();
  place_runs();
  std::erase_if(touching_, [&](auto& pair) {
    pair = {region_of_[pair.first], region_of_[pair.second]};
    return pair.first == kNoRegion || pair.second == kNoRegion;
  });
}

// Makes a region of the runs that are connected, with its box and its area.
void Regions::measure() {
  regions_.clear();
  region_of_.resize(runs_.size());
  for (Number run = 0; run < runs_.size(); ++run) {
    const auto [row, left, right] = runs_[run];
    const Number first = root(run);
    if (first == run) {
      region_of_[run] = static_cast<Number>(regions_.size());
      regions_.push_back({.box = {left, row, 0, 0}, .area = 0, .first_run = 0, .run_count = 0});
    }
    region_of_[run] = region_of_[first];
    Region& region = regions_[region_of_[run]];
    const int end = std::max(region.box.left + region.box.width, right + 1);
    region.box.left = std::min<int>(region.box.left, left);
    region.box.width = end - region.box.left;
    region.box.height = row - region.box.top + 1;
    region.area += right - left + 1;
    ++region.run_count;
  }
}

void Regions::leave_out_single_pixels() {
  renamed_.resize(regions_.size());
  Number end = 0, runs = 0;
  for (Number number = 0; number < regions_.size(); ++number) {
    renamed_[number] = regions_[number].area == 1 ? kNoRegion : end;
    if (renamed_[number] == kNoRegion) continue;
    regions_[end] = regions_[number];
    regions_[end++].first_run = runs;
    runs += regions_[number].run_count;
  }
  regions_.resize(end);
  for (Number& region : region_of_) region = renamed_[region];
}

// Puts the runs in the order of regions, counted from the corners of their boxes.
void Regions::place_runs() {
  shapes_.resize(runs_.size());
  next_.clear();
  for (const Region& region : regions_) next_.push_back(region.first_run);
  for (Number run = 0; run < runs_.size(); ++run) {
    if (region_of_[run] == kNoRegion) continue;
    const Box& box = regions_[region_of_[run]].box;
    const auto [row, first, last] = runs_[run];
    shapes_[next_[region_of_[run]]++] = {static_cast<std::uint8_t>(row - box.top),
                                         static_cast<std::uint8_t>(first - box.left),
                                         static_cast<std::uint8_t>(last - box.left)};
  }
}

}  // namespace racebeam
