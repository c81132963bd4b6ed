// A fuzz target is one function, which accepts any bytes. libFuzzer calls it with inputs that it generates
// (libfuzzer.cpp), and tests call it with those of the corpora (replay.cpp).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace racebeam::fuzz {

using Bytes = std::span<const std::uint8_t>;

// Each target defines it. It must return for every `input`, and leave nothing behind that could affect
// another input.
void run(Bytes input);

// If `holds` is false, prints `property` and `detail`, and aborts.
void require(bool holds, std::string_view property, std::string_view detail = {});

// Reads an input from its beginning. Beyond its end, bytes are 0.
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
    const Bytes part = rest_.first(std::min(most, rest_.size()));
    rest_ = rest_.subspan(part.size());
    return part;
  }
  Bytes rest() const { return rest_; }
  bool empty() const { return rest_.empty(); }

 private:
  Bytes rest_;
};

inline std::string_view text_of(Bytes bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

// Whether the text is one line of printable ASCII, as all messages must be.
inline bool is_printable(std::string_view text) {
  return std::ranges::all_of(text, [](char c) { return c >= ' ' && c <= '~'; });
}

}  // namespace racebeam::fuzz
