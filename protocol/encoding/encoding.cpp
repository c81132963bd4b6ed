#include "protocol/encoding/encoding.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <new>

#include "protocol/description/tables.hpp"
#include "protocol/encoding/base64.hpp"
#include "protocol/encoding/text.hpp"
#include "system/named_rows.hpp"

namespace racebeam {
namespace {

static_assert(same_names(kEncodingNames, description::kEncodings));
constexpr auto kEncodings = [] {
  std::array<EncodingRow, kEncodingNames.size()> rows;
  std::ranges::transform(kEncodingNames, description::kEncodings, rows.begin(),
                         [](const auto& word, const auto& described) {
                           return EncodingRow{word.value, word.name, described.summary};
                         });
  return rows;
}();

using Bytes = std::span<const std::uint8_t>;

// A piece of a long value takes a millisecond at most. It holds any screen, and whole groups of base64.
constexpr std::size_t kPiece = std::size_t{48} << 10;

constexpr std::size_t kMaxSkipped = 0xFFFF, kMaxRuns = 0xFF, kMaxInRun = 0xFF;
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

// The end of a changed part: where enough equal bytes follow that skipping them saves text.
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
  const std::size_t last = std::min(end, at + kMaxInRun);
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
  for (; at < end && runs < kMaxRuns; ++runs) {
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

// The length of the next piece. Between pieces, the text of runs is only the same where a run ends.
std::size_t any_piece(Bytes bytes) { return std::min(kPiece, bytes.size()); }
std::size_t piece_of_runs(Bytes bytes) {
  std::size_t end = any_piece(bytes);
  while (end < bytes.size() && bytes[end] == bytes[end - 1]) ++end;
  return end;
}

// Calls write(piece, is_last) for one piece after the other, and `pause` between two.
template <typename Write>
void in_pieces(Bytes bytes, const BetweenPieces& pause, std::size_t (*next)(Bytes), Write write) {
  for (bool last = false; !last;) {
    const Bytes piece = bytes.first(next(bytes));
    bytes = bytes.subspan(piece.size());
    last = bytes.empty();
    write(piece, last);
    if (!last && pause) pause();
  }
}

// A string that grows piece by piece would take up to twice the memory. There is room for what follows, too.
void make_room(std::string& out, std::size_t more) {
  if (more > kPiece) out.reserve(out.size() + more + kPiece);
}

void append_base64_in_pieces(std::string& out, Bytes bytes, const BetweenPieces& pause) {
  make_room(out, text_size(Encoding::kBase64, bytes.size()));
  in_pieces(bytes, pause, any_piece, [&out](Bytes piece, bool) { append_base64(out, piece); });
}

}  // namespace

std::span<const EncodingRow> encodings() { return kEncodings; }

std::optional<Encoding> encoding_of(std::string_view name) {
  const auto found = std::ranges::find(kEncodings, name, &EncodingRow::name);
  return found == kEncodings.end() ? std::nullopt : std::optional(found->encoding);
}

std::size_t text_size(Encoding encoding, std::size_t bytes) {
  constexpr std::size_t kRun = 4, kHeader = 6;  // digits
  const auto in_base64 = [](std::size_t count) { return (count + 2) / 3 * 4; };
  switch (encoding) {
    case Encoding::kHex: return 2 * bytes;
    case Encoding::kRunLength: return kRun * bytes;
    case Encoding::kDelta: return kRun * bytes + kHeader * (bytes / kMaxRuns + 1);
    case Encoding::kBase64: return in_base64(bytes);
    case Encoding::kZlib: return in_base64(compressBound(static_cast<uLong>(bytes)));
    case Encoding::kRaw: return bytes;
  }
  return 0;
}

void append_delta(std::string& out, Bytes bytes, std::span<std::uint8_t> before, const BetweenPieces& pause) {
  std::size_t position = 0;          // the reader knows the bytes before it
  std::size_t written = out.size();  // at the last pause
  for (;;) {
    std::size_t begin = next_difference(bytes, before, position);
    if (begin == bytes.size()) break;
    const std::size_t end = end_of_change(bytes, before, begin);
    for (; begin - position > kMaxSkipped; position += kMaxSkipped) append_header(out, kMaxSkipped, 0);
    while (begin < end) {
      const std::size_t stop = append_runs(out, begin - position, bytes, begin, end);
      std::copy_n(bytes.data() + begin, stop - begin, before.data() + begin);
      position = begin = stop;
      if (!pause || out.size() - written < kPiece) continue;
      pause();
      written = out.size();
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

  // zlib's memory for a window of 32 KiB and its usual tables (zconf.h), and the result's.
  std::size_t footprint() const { return (std::size_t{268} << 10) + packed_.capacity(); }

  Bytes deflated(Bytes bytes, const BetweenPieces& pause) {
    deflateReset(&stream_);
    packed_.resize(deflateBound(&stream_, static_cast<uLong>(bytes.size())));
    stream_.next_out = packed_.data();
    stream_.avail_out = static_cast<uInt>(packed_.size());
    in_pieces(bytes, pause, any_piece, [this](Bytes piece, bool last) {
      stream_.next_in = const_cast<Bytef*>(piece.data());
      stream_.avail_in = static_cast<uInt>(piece.size());
      deflate(&stream_, last ? Z_FINISH : Z_NO_FLUSH);
    });
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

std::size_t Encoder::footprint() const {
  return before_.capacity() + (deflater_ ? deflater_->footprint() : 0);
}

void Encoder::release_caches() { deflater_.reset(); }

void Encoder::append(std::string& out, Bytes bytes, std::string& raw, const BetweenPieces& pause) {
  switch (encoding_) {
    case Encoding::kHex:
      make_room(out, text_size(Encoding::kHex, bytes.size()));
      return in_pieces(bytes, pause, any_piece, [&out](Bytes piece, bool) { append_hex(out, piece); });
    case Encoding::kRunLength:
      return in_pieces(bytes, pause, piece_of_runs,
                       [&out](Bytes piece, bool) { append_run_length(out, piece); });
    case Encoding::kBase64: return append_base64_in_pieces(out, bytes, pause);
    case Encoding::kDelta: before_.resize(bytes.size()); return append_delta(out, bytes, before_, pause);
    case Encoding::kZlib:
      if (!deflater_) deflater_ = std::make_unique<Deflater>();
      return append_base64_in_pieces(out, deflater_->deflated(bytes, pause), pause);
    case Encoding::kRaw:
      out += std::to_string(bytes.size());
      make_room(raw, bytes.size());
      return in_pieces(bytes, pause, any_piece, [&raw](Bytes piece, bool) {
        raw.append(reinterpret_cast<const char*>(piece.data()), piece.size());
      });
  }
}

}  // namespace racebeam
