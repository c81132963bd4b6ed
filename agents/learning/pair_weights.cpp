#include "agents/learning/pair_weights.hpp"

#include <algorithm>
#include <bit>
#include <functional>
#include <stdexcept>

#include "agents/learning/action_sums.hpp"

namespace racebeam {
namespace {

constexpr std::int64_t kSettlesAfter = 32;  // decisions without a change
constexpr std::int64_t kSettleEvery = 8;    // decisions
constexpr std::size_t kRowsAhead = 12;      // rows of weights that are on their way from memory

constexpr std::uint64_t history_of(std::size_t decisions) {
  return decisions == 0 ? 0 : ~std::uint64_t{0} >> (64 - decisions);
}

// The sizes of a trace at each decision after the one that it begins with, as Sarsa's traces have them.
std::vector<float> sizes_of_trace(const SarsaSettings& settings) {
  const auto decay = static_cast<float>(settings.discount * settings.trace_decay);
  const auto least = static_cast<float>(settings.least_trace);
  std::vector<float> sizes{1};
  while (sizes.size() <= PairWeights::kMaxTraces) {
    const float next = sizes.back() * decay;
    if (next < least || next == 0) break;
    sizes.push_back(next);
  }
  return sizes;
}

void insert(std::vector<std::uint16_t>& bits, std::uint16_t bit) {
  bits.insert(std::ranges::lower_bound(bits, bit), bit);
}

void erase(std::vector<std::uint16_t>& bits, std::uint16_t bit) {
  bits.erase(std::ranges::lower_bound(bits, bit));
}

template <typename To, typename From>
void add(To& to, const From& from) {
  for (std::size_t action = 0; action < to.size(); ++action) to[action] += from[action];
}

template <typename From, typename Values>
void subtract(From& from, const Values& values) {
  for (std::size_t action = 0; action < from.size(); ++action) from[action] -= values[action];
}

void add_times(ActionValues& to, const ActionValues& values, double times) {
  for (std::size_t action = 0; action < to.size(); ++action) to[action] += times * values[action];
}

template <typename Row>
Row narrow(const ActionValues& values) {
  Row row;
  std::ranges::transform(values, row.begin(), [](double value) { return static_cast<float>(value); });
  return row;
}

}  // namespace

std::size_t PairWeights::decisions_of_trace(const SarsaSettings& settings) {
  const std::size_t decisions = sizes_of_trace(settings).size();
  return decisions > kMaxTraces ? 0 : decisions;
}

PairWeights::PairWeights(const SarsaSettings& settings)
    : trace_sizes_(sizes_of_trace(settings)),
      clear_other_traces_(settings.clear_other_traces),
      table_(pairs(kBits)),
      amounts_(trace_sizes_.size()) {
  if (trace_sizes_.size() > kMaxTraces)
    throw std::invalid_argument("traces last for more than " + std::to_string(kMaxTraces) + " decisions");
}

void PairWeights::begin(Ram ram) {
  enter_all_moves();
  std::ranges::copy(ram, state_.begin());
  steady_.clear();
  for (Bit bit = 0; bit < kBits; ++bit)
    if (is_one(bit)) steady_.push_back(bit);
  unsettled_.clear();
  varying_.clear();
  is_unsettled_ = {};
  episode_ = 0;
  taken_ = {};
  settled_at_ = now_;
  ActionSums sums;
  for (std::size_t i = 0; i < steady_.size(); ++i)
    for (std::size_t j = 0; j <= i; ++j) sums.add(table_[place(steady_[i], steady_[j])].data());
  sums_ = sums.values();
}

// Bits become 0 before others become 1, so that fewer pairs are looked at.
void PairWeights::look(Ram ram) {
  std::array<std::uint8_t, kRamSize> changed;
  std::ranges::transform(ram, state_, changed.begin(), std::bit_xor());
  for (const bool ones : {true, false}) {
    for (std::size_t byte = 0; byte < changed.size(); ++byte) {
      const unsigned of_kind = changed[byte] & (ones ? state_[byte] : ram[byte]);
      for (unsigned bits = of_kind; bits != 0; bits &= bits - 1) {
        const auto bit = static_cast<Bit>(8 * byte + static_cast<unsigned>(std::countr_zero(bits)));
        ones ? clear_bit(bit) : set_bit(bit);
      }
    }
  }
  std::ranges::copy(ram, state_.begin());
}

void PairWeights::clear_bit(Bit bit) {
  if (is_unsettled_[bit])
    erase(varying_, bit);
  else
    leave_steady(bit);
  subtract(sums_, sum_with_state(bit));
  changed_at_[bit] = now_;
}

void PairWeights::set_bit(Bit bit) {
  if (!is_unsettled_[bit]) unsettle(bit, 0);
  add(sums_, sum_with_state(bit));
  insert(varying_, bit);
  changed_at_[bit] = now_;
}

void PairWeights::leave_steady(Bit bit) {
  erase(steady_, bit);
  for (const Bit other : unsettled_)
    if (knows_with_steady_[other]) subtract(with_steady_[other], table_[place(bit, other)]);
  enter_moves_of(bit);
  unsettle(bit, episode_);
}

// What the pairs of a bit that was steady were moved enters the table.
void PairWeights::enter_moves_of(Bit bit) {
  if (!is_deferred_) return;
  const Row moves = narrow<Row>(of_steady_);
  add(table_[place(bit, bit)], moves);
  for (const Bit other : steady_) add(table_[place(bit, other)], moves);
  for (const Bit other : unsettled_) add(table_[place(bit, other)], narrow<Row>(of_unsettled_[other]));
  add_times(sums_, of_steady_, static_cast<double>(1 + steady_.size()));
  for (const Bit other : varying_) add(sums_, of_unsettled_[other]);
}

void PairWeights::unsettle(Bit bit, History history) {
  is_unsettled_[bit] = true;
  knows_with_steady_[bit] = false;
  unsettled_.push_back(bit);
  history_[bit] = history;
  of_unsettled_[bit] = {};
}

// The sum over an unsettled bit, which is in no list, and its pairs with the present state.
ActionValues PairWeights::sum_with_state(Bit bit) {
  if (!knows_with_steady_[bit]) {
    with_steady_[bit] = sum_with(bit, steady_);
    knows_with_steady_[bit] = true;
  }
  ActionValues sum = sum_with(bit, varying_);
  add(sum, with_steady_[bit]);
  add(sum, table_[place(bit, bit)]);
  return sum;
}

ActionValues PairWeights::sum_with(Bit bit, std::span<const Bit> others) const {
  ActionSums sums;
  for (std::size_t i = 0; i < others.size(); ++i) {
    if (i + kRowsAhead < others.size()) {
      const Row& ahead = table_[place(bit, others[i + kRowsAhead])];
      __builtin_prefetch(&ahead.front());
      __builtin_prefetch(&ahead.back());
    }
    sums.add(table_[place(bit, others[i])].data());
  }
  return sums.values();
}

void PairWeights::take(int action) {
  const History all = history_of(trace_sizes_.size());
  episode_ = (episode_ << 1 | 1) & all;
  for (History& taken : taken_) taken = taken << 1 & all;
  taken_[static_cast<std::size_t>(action)] |= 1;
  for (const Bit bit : unsettled_) history_[bit] = (history_[bit] << 1 | History{is_one(bit)}) & all;
  ++now_;
  if (now_ - settled_at_ >= kSettleEvery) settle();
}

void PairWeights::move(float step) {
  if (step == 0) return;
  is_deferred_ = true;
  recent_.clear();
  for (std::size_t action = 0; action < taken_.size(); ++action)
    if (taken_[action] != 0) recent_.push_back(action);
  std::ranges::transform(trace_sizes_, amounts_.begin(), [step](float size) { return step * size; });
  for (const Move& move : moves_of(episode_)) of_steady_[move.action] += double{move.amount};
  group_unsettled();
  const std::span<const Group> groups(groups_.data(), group_count_);
  for (const Group& group : groups)
    for (const Move& move : moves_of(group.history))
      for (const Bit bit : group.bits) of_unsettled_[bit][move.action] += double{move.amount};
  for (const Group& group : groups)
    for (const Group* other = groups.data(); other <= &group; ++other)
      if (const History both = group.history & other->history) move_pairs(group, *other, moves_of(both));
}

// How a feature moves that was active in the decisions of this history.
std::span<const PairWeights::Move> PairWeights::moves_of(History history) {
  std::size_t count = 0;
  if (clear_other_traces_) history &= -history;
  for (const std::size_t action : recent_) {
    const History taken = taken_[action] & history;
    if (taken != 0) moves_[count++] = {action, amounts_[static_cast<std::size_t>(std::countr_zero(taken))]};
  }
  return {moves_.data(), count};
}

void PairWeights::group_unsettled() {
  group_count_ = 0;
  for (const Bit bit : unsettled_) {
    const History history = history_[bit];
    if (history == 0) continue;
    std::size_t at = 0;
    while (at < group_count_ && groups_[at].history != history) ++at;
    if (at == group_count_) {
      if (at == groups_.size()) groups_.emplace_back();
      groups_[at].history = history;
      groups_[at].bits.clear();
      groups_[at].ones = 0;
      ++group_count_;
    }
    groups_[at].bits.push_back(bit);
    groups_[at].ones += is_one(bit);
  }
}

void PairWeights::move_pairs(const Group& one, const Group& other, std::span<const Move> moves) {
  const bool same = &one == &other;
  const auto active = static_cast<double>(same ? pairs(one.ones) : one.ones * other.ones);
  for (const Move& move : moves) sums_[move.action] += active * double{move.amount};
  for (std::size_t i = 0; i < one.bits.size(); ++i) {
    const std::size_t end = same ? i + 1 : other.bits.size();
    for (std::size_t j = 0; j < end; ++j) {
      Row& row = table_[place(one.bits[i], other.bits[j])];
      for (const Move& move : moves) row[move.action] += move.amount;
    }
  }
}

ActionValues PairWeights::values() const {
  if (!is_deferred_) return sums_;
  ActionValues of_varying{}, values = sums_;
  for (const Bit bit : varying_) add(of_varying, of_unsettled_[bit]);
  add_times(values, of_varying, static_cast<double>(steady_.size()));
  add_times(values, of_steady_, static_cast<double>(pairs(steady_.size())));
  return values;
}

void PairWeights::enter_all_moves() {
  if (!is_deferred_) return;
  sums_ = values();
  const Row moves = narrow<Row>(of_steady_);
  for (std::size_t i = 0; i < steady_.size(); ++i)
    for (std::size_t j = 0; j <= i; ++j) add(table_[place(steady_[i], steady_[j])], moves);
  for (const Bit bit : unsettled_) {
    const Row moves_of_bit = narrow<Row>(of_unsettled_[bit]);
    for (const Bit other : steady_) add(table_[place(bit, other)], moves_of_bit);
    of_unsettled_[bit] = {};
  }
  of_steady_ = {};
  is_deferred_ = false;
}

// A bit settles only after its last change has left all traces.
void PairWeights::settle() {
  const std::int64_t after = std::max<std::int64_t>(kSettlesAfter, std::ssize(trace_sizes_));
  const auto settling = std::partition(unsettled_.begin(), unsettled_.end(),
                                       [&](Bit bit) { return now_ - changed_at_[bit] <= after; });
  for (auto left = unsettled_.end() - settling; left != 0; --left) {
    const Bit bit = unsettled_.back();
    unsettled_.pop_back();
    is_unsettled_[bit] = false;
    is_one(bit) ? enter_steady(bit) : enter_moves_with_steady(bit);
  }
  settled_at_ = now_;
}

// The deferred moves of a bit's pairs with steady ones enter the table.
void PairWeights::enter_moves_with_steady(Bit bit) {
  if (!is_deferred_) return;
  const Row moves = narrow<Row>(of_unsettled_[bit]);
  for (const Bit other : steady_) add(table_[place(bit, other)], moves);
}

// From now on, the deferred moves of steady bits hold for the pairs of this one, too. The table subtracts
// those that were made before.
void PairWeights::enter_steady(Bit bit) {
  erase(varying_, bit);
  enter_moves_with_steady(bit);
  const auto others = static_cast<double>(steady_.size());
  add_times(sums_, of_unsettled_[bit], others);
  add_times(sums_, of_steady_, -(1 + others));
  const Row of_steady = narrow<Row>(of_steady_);
  subtract(table_[place(bit, bit)], of_steady);
  for (const Bit other : steady_) subtract(table_[place(bit, other)], of_steady);
  for (const Bit other : unsettled_) {
    Row& row = table_[place(bit, other)];
    subtract(row, narrow<Row>(of_unsettled_[other]));
    if (knows_with_steady_[other]) add(with_steady_[other], row);
  }
  for (const Bit other : varying_) subtract(sums_, of_unsettled_[other]);
  insert(steady_, bit);
}

void PairWeights::end() { enter_all_moves(); }

double PairWeights::weight(std::size_t bit, std::size_t other, int action) const {
  const auto of_action = static_cast<std::size_t>(action);
  const auto is_steady = [&](std::size_t each) {
    return is_one(static_cast<Bit>(each)) && !is_unsettled_[each];
  };
  double deferred = 0;
  if (is_steady(bit) && is_steady(other))
    deferred = of_steady_[of_action];
  else if (is_steady(bit) && is_unsettled_[other])
    deferred = of_unsettled_[other][of_action];
  else if (is_steady(other) && is_unsettled_[bit])
    deferred = of_unsettled_[bit][of_action];
  return double{table_[place(bit, other)][of_action]} + deferred;
}

void PairWeights::read(StateReader& in) {
  in.get(table_);
  if (table_.size() != pairs(kBits)) throw InvalidInput("the checkpoint is of another number of features");
}

}  // namespace racebeam
