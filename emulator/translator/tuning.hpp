// The numbers by which the translator chooses between ways that give the same result. They affect speed only.
// Each group names the file that uses it, and each number its unit and its reason. The numbers of the budget
// are in translation_budget.hpp.
//
// Two commands show what another value costs: `scripts/bench core`, over all games, and
// `scripts/translator-cost`, whose bound is 1.5 times the time of the interpreter. The numbers were chosen
// together; what each one by itself is worth has not been measured.
#pragma once

#include <cstdint>

namespace racebeam::translator::tuning {

// What is translated at once (block_discovery.cpp).
// The most work of a batch, where an instruction counts 1: some 50 microseconds. With less, less code is
// translated that seldom runs.
constexpr int kMostWork = 100;
constexpr int kWorkOfBlock = 3;        // of a batch: what a block costs beside its instructions
constexpr int kMostBlockCycles = 300;  // of a block, without the waiting of WSYNC

// Whether an entry into translated code saves time (profitability.hpp).
// An entry that runs this many cycles takes about as long as interpreting them, if some access devices.
constexpr std::int32_t kBreakEvenCycles = 32;
constexpr std::int32_t kMostBalance = 4 * kBreakEvenCycles;  // cycles beyond break-even, on either side
constexpr std::uint8_t kRetry = 64;  // searches, one of which enters all the same: another scene may differ

// How long the interpreter runs before the next search (translator.cpp), in instructions.
constexpr std::int32_t kOutsideImage = 8;  // at least where nothing can be translated: short routines in RAM
constexpr std::int32_t kLongestRun = 128;  // the count doubles up to this
constexpr std::int32_t kShortRun = 32;     // runs below this end exactly
constexpr std::int32_t kRunSlack = 4096;   // so much later others end, at a jump or branch

// Steps that are interpreted after one that was too long for translated code (translator.cpp).
constexpr int kLongestBackoff = 63;
constexpr int kCalmSteps = 4;  // that translated code completed; they halve the count

// Whether steps are faster translated (step_trial.hpp).
constexpr int kTrialsOfRound = 4;
constexpr int kRoundsToLose = 3;  // in turn, until the usual way changes: other programs lengthen some steps
constexpr std::int64_t kTrialMargin = 4;  // the winner is faster by this part
// Steps between trials: multiples of four, so that a round tries each of four successive steps. Games do
// different work in even and odd frames, and frame skip shows one frame of several.
constexpr int kShortestPause = 4, kLongestPause = 1024;
constexpr int kLongestTried = 64;  // while steps are interpreted: code that pays is soon found again
constexpr int kFirstPause = 128;   // translation of a game's inner loops needs some of these steps

}  // namespace racebeam::translator::tuning
