// The run-length text of a screen. A first pass finds, for each row of 160 pixels, where runs begin and
// whether the row equals the one above. It handles many rows at a time, with SIMD where the processor has it.
// A second pass writes the text. A row that equals the one above, and begins within a run of the same length,
// has the same text. Most rows do.
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "protocol/encoding/text.hpp"
#include "protocol/encoding/text_forms.hpp"

namespace racebeam {
namespace {

constexpr std::size_t kRowsAtOnce = 64;
constexpr std::int32_t kLongestRun = 255;

// Bit i: byte i of `word` is not zero.
std::uint32_t nonzero_bytes(std::uint64_t word) {
  constexpr std::uint64_t kSeven = 0x7F7F7F7F7F7F7F7F;
  const std::uint64_t high_bits = ((word & kSeven) + kSeven) | word;
  return static_cast<std::uint32_t>(((high_bits >> 7 & 0x0101010101010101) * 0x0102040810204080) >> 56);
}

// before: the pixel before the row.
void find_begins(const std::uint8_t* row, std::uint8_t before, RowFacts& facts) {
  facts.begins = {};
  std::uint64_t last = before;
  for (unsigned i = 0; i < kRow; i += 8) {
    std::uint64_t word;
    std::memcpy(&word, row + i, sizeof word);
    facts.begins[i / 32] |= nonzero_bytes(word ^ (word << 8 | last)) << i % 32;
    last = word >> 56;
  }
}

// Facts of `count` rows. Each must have a row before it.
void find_plain(const std::uint8_t* row, std::size_t count, RowFacts* facts) {
  for (std::size_t i = 0; i < count; ++i, row += kRow) {
    facts[i].repeats = std::memcmp(row, row - kRow, kRow) == 0;
    if (i > 0 && facts[i].repeats != 0) {
      facts[i].begins = facts[i - 1].begins;
      facts[i].begins[0] = (facts[i].begins[0] & ~1U) | (row[0] != row[-1]);
    } else {
      find_begins(row, row[-1], facts[i]);
    }
  }
}

void find_facts(const std::uint8_t* row, std::size_t count, RowFacts* facts, [[maybe_unused]] Simd form) {
  if constexpr (kHasAvx) {
    if (form >= Simd::kAvx2) return find_avx2(row, count, facts);
  }
  if constexpr (kHasNeon) {
    if (form == Simd::kNeon) return find_neon(row, count, facts);
  }
  find_plain(row, count, facts);
}

// Writes the text row by row into its own buffer, because growing a string costs more than a run.
class RunWriter {
 public:
  RunWriter(std::string& out, std::uint8_t first) : out_(out), open_{first, 0} {}

  void add_row(const std::uint8_t* row, const RowFacts& facts) {
    if (text_.size() - used_ < kMaxOfRow) flush();
    if (facts.repeats != 0 && above_ != kGone && open_ == open_above_) {
      copy_row_above();
    } else {
      write_row(row, facts);
    }
    open_.begin -= static_cast<std::int32_t>(kRow);
  }

  // Adds the pixels after the last whole row.
  void add_rest(std::span<const std::uint8_t> pixels) {
    if (text_.size() - used_ < kMaxOfRow) flush();
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      if (pixels[i] != open_.color) end_run(static_cast<std::int32_t>(i), pixels[i]);
    }
    end_run(static_cast<std::int32_t>(pixels.size()), open_.color);
    flush();
  }

 private:
  static constexpr std::size_t kGroup = 4;  // characters
  static constexpr std::size_t kMaxOfRow = (kRow + 1) * kGroup;
  static constexpr std::size_t kGone = ~std::size_t{0};

  struct Open {  // the run that has begun
    std::uint8_t color;
    std::int32_t begin;  // relative to the start of the row
    bool operator==(const Open&) const = default;
  };

  void write_row(const std::uint8_t* row, const RowFacts& facts) {
    open_above_ = open_;
    above_ = used_;
    for (std::size_t word = 0; word < facts.begins.size(); ++word) {
      for (std::uint32_t bits = facts.begins[word]; bits != 0; bits &= bits - 1) {
        const std::int32_t at = static_cast<std::int32_t>(32 * word) + std::countr_zero(bits);
        end_run(at, row[at]);
      }
    }
    above_size_ = used_ - above_;
    open_below_ = open_;
  }

  // The same run is open as at the start of the row above, so the same runs end, and the same run stays open.
  void copy_row_above() {
    std::memcpy(&text_[used_], &text_[above_], above_size_);
    used_ += above_size_;
    open_ = open_below_;
  }

  void end_run(std::int32_t at, std::uint8_t next) {
    std::int32_t length = at - open_.begin;
    for (; length > kLongestRun; length -= kLongestRun) {
      add_group(kLongestRun);
      if (text_.size() - used_ < kMaxOfRow) flush();
    }
    add_group(length);
    open_ = {next, at};
  }

  void add_group(std::int32_t length) {
    const std::uint32_t digits = kHexPairs[static_cast<std::size_t>(length)];
    const std::uint32_t group = kHexPairs[open_.color] | digits << 16;
    std::memcpy(&text_[used_], &group, kGroup);
    used_ += kGroup;
  }

  void flush() {
    out_.append(text_.data(), used_);
    used_ = 0;
    above_ = kGone;
  }

  std::string& out_;
  Open open_, open_above_{}, open_below_{};  // now; at the start and the end of the row that was written last
  std::size_t above_ = kGone, above_size_ = 0;  // that row's text
  std::size_t used_ = 0;
  std::array<char, 16384> text_;
};

}  // namespace

void append_run_length(std::string& out, std::span<const std::uint8_t> pixels, Simd form) {
  if (pixels.empty()) return;
  std::array<RowFacts, kRowsAtOnce> facts;
  RunWriter runs(out, pixels[0]);
  if (pixels.size() >= kRow) {
    facts[0].repeats = 0;
    find_begins(pixels.data(), pixels[0], facts[0]);
    runs.add_row(pixels.data(), facts[0]);
    pixels = pixels.subspan(kRow);
  }
  while (pixels.size() >= kRow) {
    const std::size_t count = std::min(kRowsAtOnce, pixels.size() / kRow);
    find_facts(pixels.data(), count, facts.data(), form);
    for (std::size_t row = 0; row < count; ++row) runs.add_row(&pixels[row * kRow], facts[row]);
    pixels = pixels.subspan(count * kRow);
  }
  runs.add_rest(pixels);
}

}  // namespace racebeam
