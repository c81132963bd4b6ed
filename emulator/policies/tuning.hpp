// The tuning table of the emulator: the numbers by which it chooses between methods with the same result
// (system/tuning.hpp). Each group names the file that uses it. What the numbers are worth, and what half and
// double of them cost, is measured: docs/performance/tuning.md. The bound of `scripts/translator-cost`, 1.5
// times the time of the interpreter, holds for all numbers of the translator together.
#pragma once

#include <cstdint>

#include "system/tuning.hpp"

namespace racebeam::tuning {

// Frames that are not observed: followed or drawn (deferred_render_policy.hpp).

// Frames at the beginning of a probe, until the rows that are recalled are those of the frames before.
RACEBEAM_TUNED(unsigned, kSettlingFrames, 4, "frames", "frames");
// Measured frames of a probe. A multiple of the common patterns: frame skip 2 to 5 with one or two frames
// observed, and games that do different work in each of two or four frames.
RACEBEAM_TUNED(unsigned, kMeasuredFrames, 12, "frames", "frames");
// Frames from one decision to the next, if the last one was new.
RACEBEAM_TUNED(unsigned, kShortestPeriod, 512, "frames", "frames");
// The longest such time; it doubles while decisions stay the same.
RACEBEAM_TUNED(unsigned, kLongestPeriod, 4096, "frames", "frames");
// Observed frames in turn that are measured; more belong to another use of the machine.
RACEBEAM_TUNED(unsigned, kMostObserved, 2, "frames", "frames");

// Two sets of line records, for games that flicker (emulator/tia/line_cache/flicker_detector.hpp).

// Frames from one try to the next, if the last one changed the answer.
RACEBEAM_TUNED(int, kShortestFlickerPeriod, 64, "frames", "frames");
// The longest such time; it doubles while the answer stays the same.
RACEBEAM_TUNED(int, kLongestFlickerPeriod, 512, "frames", "frames");
// Rows in two frames that are drawn again with the same content; fewer are not worth a second set.
RACEBEAM_TUNED(int, kFlickeringRows, 16, "rows", "frames");

// What is translated at once (emulator/translator/block_discovery.cpp).

// The most work of a batch, where an instruction counts 1: some 50 microseconds. With less, less code is
// translated that seldom runs.
RACEBEAM_TUNED(int, kMostWork, 100, "instructions", "start");
// What a block costs beside its instructions.
RACEBEAM_TUNED(int, kWorkOfBlock, 3, "instructions", "start");
// The most cycles of a block, without the waiting of WSYNC. The interpreter runs this many before the line
// limit, and a hundred more.
RACEBEAM_TUNED(int, kMostBlockCycles, 300, "cycles", "frames");

// How much time a machine may spend on translation (translation_budget.hpp).

// The credit of a machine when it starts. Most games have then translated the code that they begin with
// before they have run for a few frames.
RACEBEAM_TUNED(std::int64_t, kCredit, 750'000, "ns", "start");
// The part of the credit that pays for what the system does for the memory of the code, which is not charged:
// pages of short-lived machines.
RACEBEAM_TUNED(std::int64_t, kStartCost, 200'000, "ns", "start");
// The usual cost of a batch; a batch that costs more leaves a debt.
RACEBEAM_TUNED(std::int64_t, kBatchCost, 25'000, "ns", "start");
// The most that a machine saves up.
RACEBEAM_TUNED(std::int64_t, kCapacity, 4'000'000, "ns", "start");
// Batches of the largest games; Solaris has 200.
RACEBEAM_TUNED(int, kUsualBatches, 256, "batches", "start");
// The part of its time that a machine saves up, for the usual batches.
RACEBEAM_TUNED(std::int64_t, kUsualPercent, 20, "%", "start");
// The same beyond them: such a program is hardly worth the work.
RACEBEAM_TUNED(std::int64_t, kLatePercent, 5, "%", "start");
// The most of a step that counts: the longest one takes this long on a quiet machine.
RACEBEAM_TUNED(std::int64_t, kLongestStep, 400'000, "ns", "start");
// The most of a batch that counts.
RACEBEAM_TUNED(std::int64_t, kLongestBatch, 400'000, "ns", "start");

// Whether an entry into translated code saves time (profitability.hpp).

// An entry that runs this many cycles takes about as long as interpreting them, if some access devices.
RACEBEAM_TUNED(std::int32_t, kBreakEvenCycles, 32, "cycles", "frames");
// Cycles below break-even that a machine's balance holds.
RACEBEAM_TUNED(std::int32_t, kMostDebt, 128, "cycles", "frames");
// Cycles beyond break-even that it holds: up to these, entries that pay make up for those that do not.
RACEBEAM_TUNED(std::int32_t, kMostSurplus, 4096, "cycles", "frames");
// Searches, one of which enters anyway: another scene may differ.
RACEBEAM_TUNED(std::uint32_t, kRetry, 64, "searches", "frames");

// How long the interpreter runs before the next search (interpreted_run.hpp,
// emulator/translator/translator.cpp).

// At least this where nothing can be translated: short routines in RAM.
RACEBEAM_TUNED(std::int32_t, kOutsideImage, 8, "instructions", "frames");
// The count doubles up to this.
RACEBEAM_TUNED(std::int32_t, kLongestRun, 128, "instructions", "frames");
// A run of several instructions may end this much later, at a jump or branch.
RACEBEAM_TUNED(std::int32_t, kRunSlack, 4096, "instructions", "frames");

// Steps that are interpreted after one that was too long for translated code (step_backoff.hpp).

// The most of them.
RACEBEAM_TUNED(int, kLongestBackoff, 63, "steps", "frames");
// Steps that translated code must complete before the count is halved.
RACEBEAM_TUNED(int, kCalmSteps, 4, "steps", "frames");

// Whether steps are faster translated (step_trial.hpp). Pauses are multiples of four, so that a
// round tries each of four successive steps. Games do different work in even and odd frames, and frame skip
// shows one frame of several.

// Rounds in turn that the usual way loses before it changes: other programs lengthen some steps.
RACEBEAM_TUNED(int, kRoundsToLose, 3, "rounds", "frames");
// The winner is faster by this part: 4 is a quarter.
RACEBEAM_TUNED(std::int64_t, kTrialMargin, 4, "parts", "frames");
// Steps between trials, if the usual way has just lost.
RACEBEAM_TUNED(int, kShortestPause, 4, "steps", "frames");
// The same while it wins; the pause doubles up to this.
RACEBEAM_TUNED(int, kLongestPause, 1024, "steps", "frames");
// The same while steps are interpreted: code that pays is soon found again.
RACEBEAM_TUNED(int, kLongestTried, 64, "steps", "frames");
// Where the other way takes more than twice as long, pauses grow by this factor instead of doubling.
RACEBEAM_TUNED(int, kFastGrowth, 8, "times", "start");
// Steps before the first trial: translation of a game's inner loops needs some of them.
RACEBEAM_TUNED(int, kFirstPause, 128, "steps", "frames");

}  // namespace racebeam::tuning
