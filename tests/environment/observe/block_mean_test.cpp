// Smaller pictures by the mean of whole blocks.
#include "environment/observe/block_mean.hpp"

#include <catch2/catch.hpp>
#include <vector>

namespace racebeam {
namespace {

using Bytes = std::vector<std::uint8_t>;

// A block whose cells have this sum, reduced to one.
int mean_of(int across, int down, int sum) {
  Bytes cells(static_cast<std::size_t>(across * down));
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const int left = static_cast<int>(cells.size() - i);
    cells[i] = static_cast<std::uint8_t>(sum / left);
    sum -= cells[i];
  }
  Bytes out(1);
  BlockMean(across, down, 1, 1)(cells, out);
  return out[0];
}

TEST_CASE("The mean of a block of 2 x 2 rounds halves up, that of another to the even number") {
  CHECK(mean_of(2, 2, 514) == 129);   // 128.5; the first four are ALE's, of seaquest
  CHECK(mean_of(2, 5, 1285) == 128);  // 128.5
  CHECK(mean_of(4, 6, 3084) == 128);  // 128.5
  CHECK(mean_of(10, 10, 11350) == 114);
  CHECK(mean_of(1, 2, 3) == 2);
  CHECK(mean_of(2, 1, 5) == 2);
  CHECK(mean_of(2, 2, 5) == 1);
  CHECK(mean_of(2, 2, 4 * 255) == 255);
  CHECK(mean_of(3, 7, 21 * 255) == 255);
}

TEST_CASE("Rows that are not asked for stay, and those that depend on changed ones are found") {
  const BlockMean mean(4, 6, 2, 3);
  Bytes in(24, 10), out(6, 99);
  mean(in, out, Bytes{0, 1, 0});
  CHECK(out == Bytes{99, 99, 10, 10, 99, 99});
  mean(in, out);
  CHECK(out == Bytes(6, 10));
  Bytes rows(3, 7);
  mean.depending(Bytes{0, 0, 0, 1, 0, 0}, rows);
  CHECK(rows == Bytes{0, 1, 0});
  in[4 * 5] = 14;  // the last row, in the first column
  mean(in, out);
  CHECK(out == Bytes{10, 10, 10, 10, 11, 10});
}

TEST_CASE("Both axes must shrink by a whole number") {
  CHECK(BlockMean::fits(160, 210, 80, 105));
  CHECK(BlockMean::fits(160, 210, 160, 1));
  CHECK_FALSE(BlockMean::fits(160, 210, 84, 105));
  CHECK_FALSE(BlockMean::fits(160, 210, 80, 84));
  CHECK_FALSE(BlockMean::fits(160, 210, 320, 210));
  CHECK_FALSE(BlockMean::fits(160, 210, 0, 210));
  CHECK_THROWS_WITH(BlockMean(160, 210, 84, 84),
                    Catch::Contains("160 x 210 has no whole blocks for one of 84 x 84"));
  CHECK_THROWS_WITH(BlockMean(512, 2, 256, 1), Catch::Contains("is wider than 256"));
}

}  // namespace
}  // namespace racebeam
