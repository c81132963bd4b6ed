// When a second set of line records is tried, kept and dropped.
#include <catch2/catch.hpp>
#include <functional>

#include "emulator/tia/line_cache/line_cache.hpp"

using namespace racebeam;

namespace {

constexpr std::size_t kRows = 40;

// What a row shows in a frame.
using Content = std::function<std::uint32_t(int frame, std::size_t row)>;

// Plays frames, and draws the rows that no record has, as the TIA does.
class Picture {
 public:
  // Returns how many rows were drawn.
  int play(int frames, const Content& content) {
    int drawn = 0;
    for (int n = 0; n < frames; ++n) drawn += draw(content);
    return drawn;
  }

  // Those of `frames` in which rows are drawn, after a frame in which none was.
  std::vector<int> beginnings(int frames, const Content& content) {
    std::vector<int> found;
    for (bool before = true; frames_ < frames;) {
      const bool now = draw(content) > 0;
      if (now && !before) found.push_back(frames_);
      before = now;
    }
    return found;
  }

 private:
  int draw(const Content& content) {
    cache_.begin_frame();
    cache_.aim(kRows);
    ++frames_;
    int drawn = 0;
    for (std::size_t row = 0; row < kRows; ++row) {
      LineRecord& record = cache_.row(row);
      const std::uint32_t value = content(frames_, row);
      if (record.number != kNoLine && record.event[0] == value) continue;
      record.open({});
      record.count = 1;
      record.event[0] = value;
      cache_.add(record);
      ++drawn;
    }
    return drawn;
  }

  LineCache cache_;
  int frames_ = 0;
};

Content flickers(std::size_t rows) {
  return [rows](int frame, std::size_t row) { return row < rows && frame % 2 == 0 ? 7U : 3U; };
}
std::uint32_t scrolls(int frame, std::size_t row) {
  return static_cast<std::uint32_t>(frame) + 4096U * static_cast<std::uint32_t>(row);
}
// Costs twice as much with two sets.
std::uint32_t changes_in_pairs(int frame, std::size_t row) { return scrolls(frame / 2, row); }

TEST_CASE("Eight rows that flicker are remembered in two sets, seven and a half are not") {
  Picture eight, fewer;
  eight.play(8, flickers(8));
  CHECK(eight.play(6, flickers(8)) == 0);
  const auto seven_and_a_half = [](int frame, std::size_t row) {
    return row == 7 ? (frame == 3 ? 7U : 3U) : flickers(7)(frame, row);
  };
  fewer.play(8, seven_and_a_half);
  CHECK(fewer.play(6, seven_and_a_half) == 6 * 7);
}

TEST_CASE("A second set is tried anew after 64 frames, then after twice as many, up to 512") {
  Picture picture;
  CHECK(picture.beginnings(2100, flickers(20)) == std::vector{65, 193, 449, 961, 1473, 1985});
}

TEST_CASE("Rows that show something new in each frame do not flicker") {
  Picture picture;
  picture.play(200, scrolls);
  picture.play(1, changes_in_pairs);
  CHECK(picture.play(100, changes_in_pairs) == 50 * static_cast<int>(kRows));
}

TEST_CASE("A second set is dropped where it does not save rows, and is found again") {
  for (const Content& other : {Content(scrolls), Content(changes_in_pairs)}) {
    Picture picture;
    picture.play(50, flickers(20));
    CHECK(picture.play(10, flickers(20)) == 0);
    picture.play(80, other);
    picture.play(1, changes_in_pairs);
    CHECK(picture.play(20, changes_in_pairs) == 10 * static_cast<int>(kRows));
    picture.play(140, flickers(20));
    CHECK(picture.play(10, flickers(20)) == 0);
  }
}

// Frames of which the first rows are drawn, with the same content as ever.
class Frames {
 public:
  void draw(std::size_t rows) {
    detector.begin_frame();
    if (!detector.counts()) return;
    for (std::size_t row = 0; row < rows; ++row) detector.count(records_.at(row));
  }

  FlickerDetector detector;

 private:
  std::vector<LineRecord> records_ = std::vector<LineRecord>(kRows);
};

TEST_CASE("Rows of four frames after a try begins and of the last two before the next are counted") {
  constexpr int kPeriod = tuning::kShortestFlickerPeriod / 2;  // of the first try
  Frames frames;
  std::vector<int> counted;
  for (int frame = 1; frame < kPeriod + 10; ++frame) {
    frames.draw(0);
    if (frames.detector.counts()) counted.push_back(frame);
  }
  CHECK(counted == std::vector{2, 3, 4, 5, kPeriod - 2, kPeriod - 1, kPeriod + 2, kPeriod + 3, kPeriod + 4,
                               kPeriod + 5});
}

TEST_CASE("Flicker is found in the first frame after those that are compared") {
  Frames frames;
  for (int frame = 1; frame <= 6; ++frame) {
    CHECK_FALSE(frames.detector.found());
    frames.draw(tuning::kFlickeringRows / 2);
  }
  CHECK(frames.detector.found());
}

// Whether a second set is kept in three tries. In each, two frames with it draw this many rows, and two
// without it 16.
bool is_kept(std::size_t rows) {
  Frames frames;
  while (!frames.detector.found()) frames.draw(8);
  for (int tries = 0; tries < 3; ++tries) {
    for (int counted = 0; counted < 6;) {  // two frames with two sets, and four with one
      frames.draw(counted == 0 ? rows - 8 : 8);
      if (frames.detector.counts()) ++counted;
    }
    frames.draw(8);
    if (!frames.detector.found()) return false;
  }
  return true;
}

TEST_CASE("A second set is kept for as long as it saves a row, and then dropped") {
  CHECK(is_kept(15));
  CHECK_FALSE(is_kept(16));
}

}  // namespace
