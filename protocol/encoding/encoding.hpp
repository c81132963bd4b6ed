// The ways in which the line protocol writes bytes as text (PROTOCOL.md, "observe and look").
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace racebeam {

enum class Encoding { kHex, kRunLength, kDelta, kBase64, kZlib };

struct EncodingRow {
  Encoding encoding;
  std::string_view name;
  std::string_view summary;
};
std::span<const EncodingRow> encodings();  // in the order of Encoding
std::optional<Encoding> encoding_of(std::string_view name);

// How long `bytes` bytes are as text. What shrinks, more or less, counts as if it did not: runs and delta as
// hex, which they exceed only where hardly any two neighbours are the same, zlib as base64.
std::size_t text_size(Encoding encoding, std::size_t bytes);

// What has changed since `before`, then `before` is made equal to `bytes`; of the same size.
void append_delta(std::string& out, std::span<const std::uint8_t> bytes, std::span<std::uint8_t> before);

// Writes one field of reply after reply. What an encoding has to remember lives here; nothing is allocated
// once each has been used.
class Encoder {
 public:
  explicit Encoder(Encoding encoding);
  ~Encoder();
  Encoder(Encoder&&) noexcept;
  Encoder& operator=(Encoder&&) noexcept;

  Encoding encoding() const { return encoding_; }
  void append(std::string& out, std::span<const std::uint8_t> bytes);

 private:
  class Deflater;

  Encoding encoding_;
  std::vector<std::uint8_t> before_;    // for kDelta; zeros at first
  std::unique_ptr<Deflater> deflater_;  // for kZlib
};

}  // namespace racebeam
