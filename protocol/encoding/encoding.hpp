// The encodings of bytes in the line protocol (protocol/PROTOCOL.md, "Encodings").
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace racebeam {

enum class Encoding { kHex, kRunLength, kDelta, kBase64, kZlib, kRaw };

struct EncodingRow {
  Encoding encoding;
  std::string_view name;
  std::string_view summary;
};
std::span<const EncodingRow> encodings();  // in the order of Encoding
std::optional<Encoding> encoding_of(std::string_view name);

// The length of `bytes` bytes in a reply. Encodings of variable length count as the fixed ones: runs and
// delta as hex, zlib as base64. Runs and delta exceed hex only where hardly any two neighbours are equal.
std::size_t text_size(Encoding encoding, std::size_t bytes);

// Writes what has changed since `before`, and makes `before` equal to `bytes`. Both have the same size.
void append_delta(std::string& out, std::span<const std::uint8_t> bytes, std::span<std::uint8_t> before);

// Writes one field of reply after reply, and holds what its encodings must remember. After each encoding has
// been used once, it allocates nothing.
class Encoder {
 public:
  explicit Encoder(Encoding encoding);
  ~Encoder();
  Encoder(Encoder&&) noexcept;
  Encoder& operator=(Encoder&&) noexcept;

  Encoding encoding() const { return encoding_; }
  // Writes a value into the line `out`. `raw` gets the bytes that follow the line, with kRaw.
  void append(std::string& out, std::span<const std::uint8_t> bytes, std::string& raw);

 private:
  class Deflater;

  Encoding encoding_;
  std::vector<std::uint8_t> before_;    // for kDelta; zeros at first
  std::unique_ptr<Deflater> deflater_;  // for kZlib
};

}  // namespace racebeam
