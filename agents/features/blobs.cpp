#include "agents/features/blobs.hpp"

#include <algorithm>

namespace racebeam {
namespace {

void enclose(Box& box, int row, int first, int last) {
  const int end = std::max(box.left + box.width, last + 1);
  box.left = std::min(box.left, first);
  box.width = end - box.left;
  box.height = row - box.top + 1;  // rows ascend
}

}  // namespace

const std::vector<Blob>& Blobs::find(Screen screen) {
  runs_.clear();
  for (std::vector<Number>& runs : of_colour_) runs.clear();
  for (int row = 0; row < kFeatureHeight; ++row) {
    const auto first = static_cast<Number>(runs_.size());
    scan_row(screen.data() + std::size_t{kFeatureWidth} * static_cast<std::size_t>(row), row);
    for (Number run = first; run < runs_.size(); ++run) connect(run);
  }
  gather();
  return blobs_;
}

void Blobs::scan_row(const std::uint8_t* pixels, int row) {
  for (int first = 0; first < kFeatureWidth;) {
    const std::uint8_t colour = colour_of(pixels[first]);
    int end = first + 1;
    while (end < kFeatureWidth && colour_of(pixels[end]) == colour) ++end;
    add_pixels(row, first, end - 1, colour);
    first = end;
  }
}

// A gap within a run changes no other join: each of its pixels is nearer to an end of the gap than the reach.
void Blobs::add_pixels(int row, int first, int last, std::uint8_t colour) {
  std::vector<Number>& runs = of_colour_[colour];
  if (!runs.empty()) {
    Run& before = runs_[runs.back()];
    if (before.row == row && first - before.last <= reach_) {
      before.last = last;
      return;
    }
  }
  const auto number = static_cast<Number>(runs_.size());
  runs.push_back(number);
  runs_.push_back({row, first, last, number, colour});
}

// Joins a run with those of its colour in the rows above that are near enough.
void Blobs::connect(Number run) {
  const auto [row, first, last, parent, colour] = runs_[run];
  const std::vector<Number>& runs = of_colour_[colour];
  for (auto other = runs.rbegin(); other != runs.rend() && row - runs_[*other].row <= reach_; ++other) {
    const Run& above = runs_[*other];
    if (above.row == row || above.first > last + reach_ || first > above.last + reach_) continue;
    const Number a = root(run), b = root(*other);
    runs_[std::max(a, b)].parent = std::min(a, b);
  }
}

Blobs::Number Blobs::root(Number run) {
  while (runs_[run].parent != run) run = runs_[run].parent = runs_[runs_[run].parent].parent;
  return run;
}

void Blobs::gather() {
  blobs_.clear();
  blob_of_.resize(runs_.size());
  for (Number run = 0; run < runs_.size(); ++run) {
    const auto [row, first, last, parent, colour] = runs_[run];
    const Number origin = root(run);
    if (origin == run) {
      blob_of_[run] = static_cast<Number>(blobs_.size());
      blobs_.push_back({colour, {first, row, 0, 0}});
    }
    enclose(blobs_[blob_of_[origin]].box, row, first, last);
  }
}

}  // namespace racebeam
