// What a fuzz target is: one function, which may be given any bytes. libFuzzer calls it with inputs that it
// makes (libfuzzer.cpp), the tests with those that are kept (replay.cpp).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace racebeam::fuzz {

using Bytes = std::span<const std::uint8_t>;

// Each target defines it. It returns, whatever `input` is, and leaves nothing behind that another input could
// meet.
void run(Bytes input);

// A property that must hold. Otherwise says which does not, and aborts.
void require(bool holds, std::string_view property, std::string_view detail = {});

// Takes an input apart from its beginning. What is no longer there reads as 0.
class Reader {
 public:
  explicit Reader(Bytes input) : rest_(input) {}

  std::uint8_t byte() {
    if (rest_.empty()) return 0;
    const std::uint8_t first = rest_.front();
    rest_ = rest_.subspan(1);
    return first;
  }
  unsigned word() {
    const unsigned low = byte();
    return low | byte() * 256U;
  }
  Bytes take(std::size_t most) {
    const Bytes taken = rest_.first(std::min(most, rest_.size()));
    rest_ = rest_.subspan(taken.size());
    return taken;
  }
  Bytes rest() const { return rest_; }
  bool empty() const { return rest_.empty(); }

 private:
  Bytes rest_;
};

inline std::string_view text_of(Bytes bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// One line of printable ASCII, which all sentences for people are.
inline bool is_printable(std::string_view text) {
  return std::ranges::all_of(text, [](char c) { return c >= ' ' && c <= '~'; });
}

}  // namespace racebeam::fuzz
