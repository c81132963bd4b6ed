#include "protocol/encoding/encoding.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <new>

#include "protocol/encoding/base64.hpp"
#include "protocol/encoding/text.hpp"

namespace racebeam {
namespace {

constexpr std::array kEncodings = {
    EncodingRow{Encoding::kHex, "hex", "two digits a byte, upper case"},
    EncodingRow{Encoding::kRunLength, "rle",
                "runs: value and length, two digits each; the length is 01 to FF; runs continue across rows"},
    EncodingRow{Encoding::kDelta, "delta", "records of what changed since the last reply with this field"},
    EncodingRow{Encoding::kBase64, "base64", "RFC 4648, with padding"},
    EncodingRow{Encoding::kZlib, "zlib", "zlib (RFC 1950), then base64"},
    EncodingRow{Encoding::kRaw, "raw", "how many bytes; they follow the line of the reply, as they are"},
};

constexpr std::size_t kMostSkipped = 0xFFFF, kMostRuns = 0xFF, kMostInRun = 0xFF;
constexpr std::size_t kWorthSkipping = 16;  // a record takes as much text as one and a half runs

// The first position from `at` on where the two differ. Compares eight bytes at a time.
std::size_t next_difference(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b,
                            std::size_t at) {
  std::uint64_t left, right;
  for (; at + sizeof left <= a.size(); at += sizeof left) {
    std::memcpy(&left, a.data() + at, sizeof left);
    std::memcpy(&right, b.data() + at, sizeof right);
    if (left != right) break;
  }
  while (at < a.size() && a[at] == b[at]) ++at;
  return at;
}

// The end of a changed part: before so many equal bytes that skipping them saves text.
std::size_t end_of_change(std::span<const std::uint8_t> a, std::span<const std::uint8_t> b, std::size_t at) {
  for (;;) {
    while (at < a.size() && a[at] != b[at]) ++at;
    const std::size_t next = next_difference(a, b, at);
    if (next - at >= kWorthSkipping || next == a.size()) return at;
    at = next;
  }
}

void append_byte(std::string& out, std::size_t value) {
  const auto byte = static_cast<std::uint8_t>(value);
  append_hex(out, {&byte, 1});
}

void append_header(std::string& out, std::size_t skipped, std::size_t runs) {
  append_byte(out, skipped >> 8);
  append_byte(out, skipped & 0xFF);
  append_byte(out, runs);
}

std::size_t run_at(std::span<const std::uint8_t> bytes, std::size_t at, std::size_t end) {
  const std::size_t last = std::min(end, at + kMostInRun);
  std::size_t next = at + 1;
  while (next < last && bytes[next] == bytes[at]) ++next;
  return next - at;
}

// Writes one record: [begin, end) as runs, as many as fit. Returns where it stopped.
std::size_t append_runs(std::string& out, std::size_t skipped, std::span<const std::uint8_t> bytes,
                        std::size_t begin, std::size_t end) {
  const std::size_t header = out.size();
  append_header(out, skipped, 0);
  std::size_t runs = 0, at = begin;
  for (; at < end && runs < kMostRuns; ++runs) {
    const std::size_t length = run_at(bytes, at, end);
    append_byte(out, bytes[at]);
    append_byte(out, length);
    at += length;
  }
  std::string count;
  append_byte(count, runs);
  out.replace(header + 4, 2, count);
  return at;
}

}  // namespace

std::span<const EncodingRow> encodings() { return kEncodings; }

std::optional<Encoding> encoding_of(std::string_view name) {
  const auto found = std::ranges::find(kEncodings, name, &EncodingRow::name);
  return found == kEncodings.end() ? std::nullopt : std::optional(found->encoding);
}

std::size_t text_size(Encoding encoding, std::size_t bytes) {
  if (encoding == Encoding::kRaw) return bytes;
  const bool in_base64 = encoding == Encoding::kBase64 || encoding == Encoding::kZlib;
  return in_base64 ? (bytes + 2) / 3 * 4 : 2 * bytes;
}

void append_delta(std::string& out, std::span<const std::uint8_t> bytes, std::span<std::uint8_t> before) {
  std::size_t told = 0;  // the reader knows the bytes before it
  for (;;) {
    std::size_t begin = next_difference(bytes, before, told);
    if (begin == bytes.size()) break;
    const std::size_t end = end_of_change(bytes, before, begin);
    for (; begin - told > kMostSkipped; told += kMostSkipped) append_header(out, kMostSkipped, 0);
    while (begin < end) {
      const std::size_t stop = append_runs(out, begin - told, bytes, begin, end);
      std::copy_n(bytes.data() + begin, stop - begin, before.data() + begin);
      told = begin = stop;
    }
  }
}

// Level 1, because an agent waits for the result.
class Encoder::Deflater {
 public:
  Deflater() {
    if (deflateInit(&stream_, 1) != Z_OK) throw std::bad_alloc();
  }
  ~Deflater() { deflateEnd(&stream_); }
  Deflater(const Deflater&) = delete;
  Deflater& operator=(const Deflater&) = delete;

  std::span<const std::uint8_t> deflated(std::span<const std::uint8_t> bytes) {
    deflateReset(&stream_);
    packed_.resize(deflateBound(&stream_, bytes.size()));
    stream_.next_in = const_cast<Bytef*>(bytes.data());
    stream_.avail_in = static_cast<uInt>(bytes.size());
    stream_.next_out = packed_.data();
    stream_.avail_out = static_cast<uInt>(packed_.size());
    deflate(&stream_, Z_FINISH);
    return std::span(packed_).first(stream_.total_out);
  }

 private:
  z_stream stream_{};
  std::vector<std::uint8_t> packed_;
};

Encoder::Encoder(Encoding encoding) : encoding_(encoding) {}
Encoder::~Encoder() = default;
Encoder::Encoder(Encoder&&) noexcept = default;
Encoder& Encoder::operator=(Encoder&&) noexcept = default;

void Encoder::append(std::string& out, std::span<const std::uint8_t> bytes, std::string& raw) {
  switch (encoding_) {
    case Encoding::kHex: return append_hex(out, bytes);
    case Encoding::kRunLength: return append_run_length(out, bytes);
    case Encoding::kBase64: return append_base64(out, bytes);
    case Encoding::kDelta: before_.resize(bytes.size()); return append_delta(out, bytes, before_);
    case Encoding::kZlib:
      if (!deflater_) deflater_ = std::make_unique<Deflater>();
      return append_base64(out, deflater_->deflated(bytes));
    case Encoding::kRaw:
      raw.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
      out += std::to_string(bytes.size());
      return;
  }
}

}  // namespace racebeam
