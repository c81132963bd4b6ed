// How fast something goes that becomes faster or slower as it goes on. It is measured in rounds, each as long
// as all before it, until two of them agree.
#pragma once

#include <algorithm>
#include <cstdint>

namespace racebeam {

class SettlingRate {
 public:
  // In seconds: rounds are counted until `least`, in any case, and end at `most`, whether or not they agree.
  SettlingRate(double least, double most) : least_(least), most_(most) {}

  // One more was done. now: seconds since the start. Returns whether this suffices; if the caller waits
  // for something else, only `most` does.
  bool add(double now, bool waits = false) {
    ++count_;
    const double end = round_ == 0 ? least_ * kWarmUp : round_ == 1 ? least_ : 2 * start_;
    if (now < std::min(end, most_)) return false;
    const double before = rate_;
    rate_ = static_cast<double>(count_) / (now - start_);
    start_ = now;
    count_ = 0;
    const bool agree = rate_ < before * kAgreement && before < rate_ * kAgreement;
    return (++round_ > 1 && agree && !waits) || now >= most_;
  }

  // Of the last round, in a second; 0 if none has ended.
  double rate() const { return rate_; }

 private:
  static constexpr double kWarmUp = 0.3;     // of `least`: the first round, in which caches are filled, too
  static constexpr double kAgreement = 1.2;  // the larger rate by the smaller

  double least_, most_;
  double start_ = 0, rate_ = 0;  // of the round; of the one before
  std::int64_t count_ = 0;
  int round_ = 0;
};

}  // namespace racebeam
