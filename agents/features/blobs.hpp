// Blobs of a screen: pixels of one colour, joined across small gaps (Liang et al. 2016; docs/paper-notes.md,
// "Successors").
#pragma once

#include "agents/features/screen.hpp"
#include "agents/features/shape.hpp"

namespace racebeam {

struct Blob {
  std::uint8_t colour;
  Box box;
};

class Blobs {
 public:
  // Two pixels of one colour are of one blob if they are at most `reach` apart in x and in y.
  explicit Blobs(int reach) : reach_(reach) {}

  // All pixels of the screen are in blobs. The order is that of their first pixels.
  const std::vector<Blob>& find(Screen screen);

 private:
  using Number = std::uint32_t;

  // Pixels of a row without a gap that is wider than the reach.
  struct Run {
    int row, first, last;
    Number parent;  // an earlier run of its blob, or itself
    std::uint8_t colour;
  };

  void scan_row(const std::uint8_t* pixels, int row);
  void add_pixels(int row, int first, int last, std::uint8_t colour);
  void connect(Number run);
  Number root(Number run);
  void gather();

  const int reach_;
  std::vector<Run> runs_;
  std::array<std::vector<Number>, kColours> of_colour_;  // runs, in their order
  std::vector<Number> blob_of_;                          // per run; only of roots
  std::vector<Blob> blobs_;
};

}  // namespace racebeam
