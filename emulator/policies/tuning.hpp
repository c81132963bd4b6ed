// The tuning table of the emulator: the numbers by which it chooses between methods with the same result
// (system/tuning.hpp). Each group names the file that uses it. What the numbers are worth, and what half and
// double of them cost, is measured: docs/performance/tuning.md. The bound of `scripts/translator-cost`, 1.5
// times the time of the interpreter, holds for all numbers of the translator together.
#pragma once

#include <cstddef>
#include <cstdint>

#include "system/tuning.hpp"

namespace racebeam::tuning {

// Frames that are not observed: followed or drawn (deferred_render_policy.hpp).

// The first frames of a probe, which are not measured: the rows that they recall are still those of frames
// that were run the other way.
RACEBEAM_TUNED(unsigned, kSettlingFrames, 4, "frames", "frames");
// Measured frames of a probe. It is a multiple of the common patterns: frame skip 2 to 5 with one or two
// observed frames, and games that do different work in each of two or four frames.
RACEBEAM_TUNED(unsigned, kMeasuredFrames, 12, "frames", "frames");
// Unobserved frames from one decision to the next, if the decision changed.
RACEBEAM_TUNED(unsigned, kShortestPeriod, 512, "frames", "frames");
// The most unobserved frames from one decision to the next. The number doubles while decisions stay the
// same.
RACEBEAM_TUNED(unsigned, kLongestPeriod, 4096, "frames", "frames");
// A probe measures up to this many observed frames in succession. More belong to another use of the machine.
RACEBEAM_TUNED(unsigned, kMaxObserved, 2, "frames", "frames");

// A machine that has drawn no picture for this many frames releases its pictures' memory. An agent that looks
// at pictures does so more often.
RACEBEAM_TUNED(int, kUndrawnFrames, 32, "frames", "frames");

// Two sets of line records, for games that flicker (emulator/tia/line_cache/flicker_detector.hpp).

// Frames before the first test for flicker.
RACEBEAM_TUNED(int, kFirstFlickerPeriod, 16, "frames", "frames");
// Frames from one test for flicker to the next, if the answer changed.
RACEBEAM_TUNED(int, kShortestFlickerPeriod, 64, "frames", "frames");
// The most frames from one test for flicker to the next. The number doubles while the answer stays the same.
RACEBEAM_TUNED(int, kLongestFlickerPeriod, 512, "frames", "frames");
// A second set of records is tried if at least this many rows of two frames are drawn again with the content
// of two frames before.
RACEBEAM_TUNED(int, kFlickeringRows, 16, "rows", "frames");

// Whether reads of collision latches play the log (emulator/tia/tia.cpp).

// Writes between two reads of latches, up to which the writes are examined. If there are more, they are
// played.
RACEBEAM_TUNED(std::ptrdiff_t, kMaxExamined, 32, "writes", "frames");

// What is translated at once (emulator/translator/block_discovery.cpp).

// The most work of a batch of translation, where an instruction counts 1: some 50 microseconds. Smaller
// batches translate less code that seldom runs.
RACEBEAM_TUNED(int, kMaxWork, 100, "instructions", "start");
// The work that a block costs in addition to its instructions.
RACEBEAM_TUNED(int, kWorkOfBlock, 3, "instructions", "start");
// The most cycles of a block, without those that WSYNC waits. The interpreter runs the last cycles before
// the line limit: this many, and a hundred more.
RACEBEAM_TUNED(int, kMaxBlockCycles, 300, "cycles", "frames");

// How much time a machine may spend on translation (translation_budget.hpp).

// The credit of a machine for translation when it starts. With it, most games have translated the code that
// they begin with after a few frames.
RACEBEAM_TUNED(std::int64_t, kCredit, 750'000, "ns", "start");
// The part of the credit that pays for the system's work on the memory of the code, which is not charged. It
// matters for short-lived machines.
RACEBEAM_TUNED(std::int64_t, kStartCost, 200'000, "ns", "start");
// The usual cost of a batch. A batch starts if the budget covers this cost; if it costs more, it leaves a
// debt.
RACEBEAM_TUNED(std::int64_t, kBatchCost, 25'000, "ns", "start");
// The largest budget for translation that a machine can save up.
RACEBEAM_TUNED(std::int64_t, kCapacity, 4'000'000, "ns", "start");
// A program may make this many batches at the usual rate. It is more than the largest games need: Solaris
// has 200.
RACEBEAM_TUNED(int, kUsualBatches, 256, "batches", "start");
// The part of its time that a machine adds to its budget, while it makes no more than the usual batches.
RACEBEAM_TUNED(std::int64_t, kUsualPercent, 20, "%", "start");
// The part that it adds after that, since such a program is hardly worth the work.
RACEBEAM_TUNED(std::int64_t, kLatePercent, 5, "%", "start");
// No more than this time of a step counts for the budget. The longest step takes this long on a quiet
// machine.
RACEBEAM_TUNED(std::int64_t, kLongestStep, 400'000, "ns", "start");
// No more than this time of a batch is charged to the budget.
RACEBEAM_TUNED(std::int64_t, kLongestBatch, 400'000, "ns", "start");

// Whether an entry into translated code saves time (profitability.hpp).

// An entry that runs this many cycles takes about as long as interpreting them, if some of them access
// devices.
RACEBEAM_TUNED(std::int32_t, kBreakEvenCycles, 32, "cycles", "frames");
// The balance of a machine's entries falls to this many cycles below break-even. The machine then
// interprets.
RACEBEAM_TUNED(std::int32_t, kMaxDebt, 128, "cycles", "frames");
// The balance rises to this many cycles beyond break-even. Up to these, profitable entries make up for
// others.
RACEBEAM_TUNED(std::int32_t, kMaxSurplus, 4096, "cycles", "frames");
// While a machine interprets because of its debt, it enters code once in this many searches, since another
// scene may differ.
RACEBEAM_TUNED(std::uint32_t, kRetry, 64, "searches", "frames");

// How long the interpreter runs before the next search (interpreted_run.hpp,
// emulator/translator/translator.cpp).

// The interpreter runs at least this many instructions where nothing can be translated, such as in routines
// in RAM.
RACEBEAM_TUNED(std::int32_t, kOutsideImage, 8, "instructions", "frames");
// The most instructions that the interpreter runs before the next search. The number doubles up to this.
RACEBEAM_TUNED(std::int32_t, kLongestRun, 128, "instructions", "frames");
// A run of several instructions may be longer by this, so that it ends at a jump or branch.
RACEBEAM_TUNED(std::int32_t, kRunSlack, 4096, "instructions", "frames");

// Steps that are interpreted after one that was too long for translated code (step_backoff.hpp).

// The most steps that are interpreted after a step that was too long for translated code.
RACEBEAM_TUNED(int, kLongestBackoff, 63, "steps", "frames");
// The number of such steps is halved each time that translated code has completed this many steps.
RACEBEAM_TUNED(int, kCalmSteps, 4, "steps", "frames");

// Whether steps are faster translated (step_trial.hpp). Pauses are multiples of four, so that a
// round tries each of four successive steps. Games do different work in even and odd frames, and frame skip
// shows one frame of several.

// Rounds in succession that the usual way must lose before it changes, since other programs lengthen some
// steps.
RACEBEAM_TUNED(int, kRoundsToLose, 3, "rounds", "frames");
// The other way wins if it is faster by this part of its time: 4 is a quarter.
RACEBEAM_TUNED(std::int64_t, kTrialMargin, 4, "parts", "frames");
// Steps between trials, if the usual way has just lost.
RACEBEAM_TUNED(int, kShortestPause, 4, "steps", "frames");
// The most steps between trials while the usual way wins. The pause doubles up to this.
RACEBEAM_TUNED(int, kLongestPause, 1024, "steps", "frames");
// The most steps between trials while steps are interpreted, so that code that pays is soon found again.
RACEBEAM_TUNED(int, kLongestTried, 64, "steps", "frames");
// If the other way takes more than twice as long, pauses grow by this factor instead of doubling.
RACEBEAM_TUNED(int, kFastGrowth, 8, "times", "start");
// Steps before the first trial, some of which are needed to translate the inner loops of a game.
RACEBEAM_TUNED(int, kFirstPause, 128, "steps", "frames");

}  // namespace racebeam::tuning
