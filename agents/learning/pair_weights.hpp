// The weights of the bits of RAM and of all pairs of them, with their traces, for SARSA(lambda).
//
// A decision changes few bits. The sum of a state's weights is the one of the state before, less the pairs of
// bits that became 0, and with those of bits that became 1.
//
// Updates of weights, called moves, are deferred. A bit that has not changed for a while is settled, any
// other is unsettled. All pairs of two settled bits move alike, so that one number for each action suffices.
// So do all pairs of a settled bit with the same unsettled one. Only pairs of two unsettled bits are moved
// one by one. Deferred moves enter the table when a bit settles, when a settled bit changes, and at the end
// of an episode.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "agents/base/huge_pages.hpp"
#include "agents/base/state_bytes.hpp"
#include "agents/learning/sarsa_control.hpp"
#include "environment/environment.hpp"

namespace racebeam {

class PairWeights {
 public:
  static constexpr std::size_t kBits = 8 * kRamSize;
  static constexpr std::size_t kMaxTraces = 64;  // decisions for which a trace lasts
  using Ram = std::span<const std::uint8_t, kRamSize>;

  // Traces last as long as these settings say. Throws std::invalid_argument if that is longer than
  // kMaxTraces.
  explicit PairWeights(const SarsaSettings& settings);

  // The number of decisions for which a trace lasts, or 0 if there are more than kMaxTraces.
  static std::size_t decisions_of_trace(const SarsaSettings& settings);

  void begin(Ram ram);    // the first state of an episode
  void look(Ram ram);     // the next one
  void take(int action);  // in the present state
  void move(float step);  // each weight along its trace; traces then decay
  void end();             // ends the episode: all deferred moves enter the table

  // The number of features, and the values of the actions, in the present state.
  std::size_t active() const { return pairs(steady_.size() + varying_.size()); }
  ActionValues values() const;
  double weight(std::size_t bit, std::size_t other, int action) const;  // a bit with itself: the bit

  void write(StateWriter& out) const { out.put(table_); }  // between episodes
  void read(StateReader& in);

 private:
  using Row = std::array<float, kActions>;
  using Bit = std::uint16_t;
  using History = std::uint64_t;  // bit k: of the decision before the last k ones

  // Unsettled bits that were 1 in the same of the last decisions, so that their traces are equal.
  struct Group {
    History history;
    std::vector<Bit> bits;
    std::size_t ones;  // in the present state
  };
  struct Move {
    std::size_t action;
    float amount;
  };

  static constexpr std::size_t pairs(std::size_t bits) { return bits * (bits + 1) / 2; }
  static constexpr std::size_t place(std::size_t bit, std::size_t other) {
    return bit < other ? pairs(other) + bit : pairs(bit) + other;
  }
  bool is_one(Bit bit) const { return state_[bit / 8] >> bit % 8 & 1; }

  ActionValues sum_with(Bit bit, std::span<const Bit> others) const;
  ActionValues sum_with_state(Bit bit);
  void clear_bit(Bit bit);
  void set_bit(Bit bit);
  void unsettle(Bit bit, History history);
  void leave_steady(Bit bit);
  void enter_moves_of(Bit bit);
  void enter_all_moves();
  void settle();
  void enter_moves_with_steady(Bit bit);
  void enter_steady(Bit bit);
  void group_unsettled();
  std::span<const Move> moves_of(History history);
  void move_pairs(const Group& one, const Group& other, std::span<const Move> moves);

  std::vector<float> trace_sizes_;  // by age
  bool clear_other_traces_;
  HugeTable<Row> table_;  // of bit 0; of bits 1 and 0, of bit 1; of bits 2 and 0, ...

  std::array<std::uint8_t, kRamSize> state_{};
  std::vector<Bit> steady_;  // settled, and 1
  std::vector<Bit> unsettled_;
  std::vector<Bit> varying_;  // unsettled, and 1
  std::array<bool, kBits> is_unsettled_{};
  std::array<History, kBits> history_{};          // of unsettled bits
  std::array<std::int64_t, kBits> changed_at_{};  // decision
  std::int64_t now_ = 0, settled_at_ = 0;         // decisions

  ActionValues sums_{};                            // of the table, over the present state
  std::array<ActionValues, kBits> with_steady_{};  // of the table, over an unsettled bit with steady ones
  std::array<bool, kBits> knows_with_steady_{};
  ActionValues of_steady_{};                        // deferred moves: of two steady bits,
  std::array<ActionValues, kBits> of_unsettled_{};  // and of this unsettled one with a steady one
  bool is_deferred_ = false;                        // any move

  History episode_ = 0;                    // has a bit for each of the last decisions of the episode
  std::array<History, kActions> taken_{};  // in which of them each action was taken
  std::vector<std::size_t> recent_;        // the actions that were taken in any of them
  std::vector<float> amounts_;             // of a move, by age
  std::vector<Group> groups_;
  std::size_t group_count_ = 0;
  std::array<Move, kActions> moves_{};
};

}  // namespace racebeam
