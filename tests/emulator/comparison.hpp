// Runs the machine's TIA and the model of reference_tia.hpp through the same accesses, and compares them.
#pragma once

#include <algorithm>
#include <catch2/catch.hpp>
#include <vector>

#include "emulator/tia/line/objects.hpp"
#include "tests/emulator/bench.hpp"
#include "tests/emulator/reference/reference_tia.hpp"

namespace racebeam::test {

// kPush: a write of JSR or BRK, which make two in one cycle.
struct Access {
  enum Kind { kWrite, kPush, kLatches, kInput } kind;
  int cycle;
  unsigned reg, value;
};
using Script = std::vector<Access>;

class Comparison {
 public:
  Comparison(const Properties& properties, bool pal)
      : bench_(Rom(4096, 0xEA), properties),
        reference_({properties.ystart, properties.height, properties.hmove_blanks, pal}) {
    bench_.board.video.pal = pal;
    reference_.open_frame(0);
  }

  void play(const Script& script, int until) {
    for (const Access& access : script)
      if (access.cycle <= until) play(access);
    bench_.end_step();
    compare();
  }

  void next_frame(int cycle) {
    bench_.next_frame(cycle);
    reference_.open_frame(cycle);
  }

  void reset_in_frame() {
    bench_.reset_in_frame();
    reference_.reset_in_frame();
  }

  void save() {
    saved_state_ = bench_.state;
    saved_reference_ = reference_;
  }

  void restore() {
    bench_.restore(saved_state_);
    reference_.take_machine_of(saved_reference_);
  }

 private:
  void play(const Access& access) {
    switch (access.kind) {
      case Access::kWrite:
      case Access::kPush:
        if (access.kind == Access::kWrite)
          bench_.store_at(access.cycle, access.reg, access.value);
        else
          bench_.write_at(access.cycle, access.reg, access.value);
        reference_.write(access.cycle, access.reg, static_cast<std::uint8_t>(access.value));
        break;
      case Access::kInput:
        bench_.load_at(access.cycle, 8 + access.reg);
        reference_.touch(access.cycle);
        break;
      case Access::kLatches:
        if ((bench_.load_at(access.cycle, access.reg) & 0xC0U) == reference_.read(access.cycle, access.reg))
          break;
        FAIL("collision register " << access.reg << " at line " << access.cycle / kLineCycles << ", cycle "
                                   << access.cycle % kLineCycles);
    }
  }

  void compare() {
    const auto ours = bench_.picture().pixels();
    const auto& theirs = reference_.buffers()[static_cast<std::size_t>(reference_.current())];
    const auto [at, expected] = std::mismatch(ours.begin(), ours.end(), theirs.begin());
    if (at != ours.end())
      FAIL("row " << (at - ours.begin()) / 160 << ", pixel " << (at - ours.begin()) % 160 << " is "
                  << int{*at} << ", not " << int{*expected});
    REQUIRE(int{bench_.state.tia.enabled} == int{enabled_objects(bench_.state.tia)});
    const std::string difference = reference_.difference(bench_.state.tia);
    if (!difference.empty()) FAIL(difference);
  }

  Bench bench_;
  ReferenceTia reference_;
  State saved_state_{};
  ReferenceTia saved_reference_{{}};
};

}  // namespace racebeam::test
