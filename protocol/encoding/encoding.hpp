// The encodings of bytes in the line protocol (protocol/PROTOCOL.md, "Encodings").
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "system/words.hpp"

namespace racebeam {

enum class Encoding { kHex, kRunLength, kDelta, kBase64, kZlib, kRaw };

// The names in protocol/protocol.toml.
inline constexpr std::array<WordFor<Encoding>, 6> kEncodingNames = {{{"hex", Encoding::kHex},
                                                                     {"rle", Encoding::kRunLength},
                                                                     {"delta", Encoding::kDelta},
                                                                     {"base64", Encoding::kBase64},
                                                                     {"zlib", Encoding::kZlib},
                                                                     {"raw", Encoding::kRaw}}};

struct EncodingRow {
  Encoding encoding;
  std::string_view name;
  std::string_view summary;
};
std::span<const EncodingRow> encodings();  // in the order of Encoding
std::optional<Encoding> encoding_of(std::string_view name);

// The greatest length of `bytes` bytes in a reply. Runs and delta reach it if no two neighbours are equal, as
// in the red, green and blue of a colour; mostly they are far shorter.
std::size_t text_size(Encoding encoding, std::size_t bytes);

// Called between two pieces of a long value; may suspend its caller, or throw. Empty: nothing is called.
using BetweenPieces = std::function<void()>;

// Writes what has changed since `before`, and makes `before` equal to `bytes`. Both have the same size.
void append_delta(std::string& out, std::span<const std::uint8_t> bytes, std::span<std::uint8_t> before,
                  const BetweenPieces& pause = {});

// Writes one field of successive replies, and holds the state of its encodings. After each encoding has been
// used once, it allocates nothing before rest().
class Encoder {
 public:
  explicit Encoder(Encoding encoding);
  ~Encoder();
  Encoder(Encoder&&) noexcept;
  Encoder& operator=(Encoder&&) noexcept;

  Encoding encoding() const { return encoding_; }
  std::size_t footprint() const;  // bytes of memory
  void release_caches();          // releases memory that the next value can allocate again
  // Writes a value into the line `out`. `raw` gets the bytes that follow the line, with kRaw. Only a stack of
  // screens is so long that it is written in several pieces.
  void append(std::string& out, std::span<const std::uint8_t> bytes, std::string& raw,
              const BetweenPieces& pause = {});

 private:
  class Deflater;

  Encoding encoding_;
  std::vector<std::uint8_t> before_;    // for kDelta; zeros at first
  std::unique_ptr<Deflater> deflater_;  // for kZlib
};

}  // namespace racebeam
