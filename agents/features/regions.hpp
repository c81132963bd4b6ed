// Regions of a screen: connected pixels of one colour that are not the background's ("Blob extraction" of
// appendix A.3 of the paper; docs/paper-notes.md, "Objects").
#pragma once

#include <utility>

#include "agents/features/background.hpp"
#include "agents/features/shape.hpp"

namespace racebeam {

struct Region {
  Box box;
  int area;
  std::uint32_t first_run, run_count;
};

class Regions {
 public:
  explicit Regions(const Background& background);

  // Finds the regions of a screen. Pixels of one colour are connected if they are neighbours in a row, a
  // column or a diagonal. Single pixels are not regions.
  void find(Screen screen);

  const std::vector<Region>& all() const { return regions_; }  // in the order of their first pixels
  ShapeView shape(const Region& region) const {
    return ShapeView(shapes_).subspan(region.first_run, region.run_count);
  }
  // Regions with pixels that are neighbours, by their places in all(). A pair can be there twice.
  const std::vector<std::pair<std::uint32_t, std::uint32_t>>& touching() const { return touching_; }

 private:
  using Number = std::uint32_t;

  void scan_row(const std::uint8_t* pixels, const std::uint8_t* behind, std::uint8_t row);
  void add_pixel(std::uint8_t row, std::uint8_t column, std::uint8_t colour);
  void connect_rows(Number above, Number row);
  void connect(Number run, Number other);
  Number root(Number run);
  void gather();
  void measure();
  void leave_out_single_pixels();
  void place_runs();

  Background behind_;  // palette indices with the lowest bit clear
  std::vector<PixelRun> runs_;
  std::vector<std::uint8_t> colours_;  // per run
  std::vector<Number> parent_;         // per run: an earlier one of its region, or itself
  std::vector<std::pair<Number, Number>> touching_;
  std::vector<Number> region_of_;  // per run
  std::vector<Number> renamed_;    // per region: its number without single pixels
  std::vector<Number> next_;       // per region: the place of its next run in shapes_
  std::vector<Region> regions_;
  std::vector<PixelRun> shapes_;
};

}  // namespace racebeam
