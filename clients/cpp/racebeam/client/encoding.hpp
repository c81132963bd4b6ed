/// @file
/// The encodings of fields, and their bytes. Any thread may call these functions.
#pragma once

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "racebeam/client/config.hpp"

namespace RACEBEAM_CLIENT_NAMESPACE {

/// What fields such as ram and screen consist of.
using Bytes = std::vector<std::uint8_t>;

/// The encodings of fields that are bytes (protocol/PROTOCOL.md, "Encodings"). Each decoder throws
/// std::invalid_argument if the text has another form.
enum class Encoding { kHex, kRle, kDelta, kBase64, kZlib, kRaw };

/// The encoding of this name, if there is one.
inline std::optional<Encoding> encoding_of(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, Encoding>, 6> kNames{{{"hex", Encoding::kHex},
                                                                         {"rle", Encoding::kRle},
                                                                         {"delta", Encoding::kDelta},
                                                                         {"base64", Encoding::kBase64},
                                                                         {"zlib", Encoding::kZlib},
                                                                         {"raw", Encoding::kRaw}}};
  for (const auto& [word, encoding] : kNames)
    if (word == name) return encoding;
  return std::nullopt;
}

namespace detail {

using Digits = std::array<std::int8_t, 256>;  // the value of each character, or -1

constexpr Digits digits(std::string_view alphabet, std::string_view also) {
  Digits values{};
  values.fill(-1);
  for (std::size_t value = 0; value < alphabet.size(); ++value)
    values[static_cast<unsigned char>(alphabet[value])] = static_cast<std::int8_t>(value);
  for (std::size_t value = 0; value < also.size(); ++value)
    values[static_cast<unsigned char>(also[value])] =
        static_cast<std::int8_t>(alphabet.size() - also.size() + value);
  return values;
}

inline constexpr std::string_view kBase64 =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
inline constexpr Digits kHexDigits = digits("0123456789ABCDEF", "abcdef");
inline constexpr Digits kBase64Digits = digits(kBase64, "");

/// Reads a text of hexadecimal digits from the front.
class HexReader {
 public:
  explicit HexReader(std::string_view text) : text_(text) {}

  bool at_end() const { return at_ >= text_.size(); }

  std::uint8_t octet() {
    const int high = digit(at_), low = digit(at_ + 1);
    if ((high | low) < 0)
      throw std::invalid_argument(
          std::string("not a byte in hexadecimal: '").append(text_.substr(at_, 2)).append("'"));
    at_ += 2;
    return static_cast<std::uint8_t>(high << 4 | low);
  }

 private:
  int digit(std::size_t at) const {
    return at < text_.size() ? kHexDigits[static_cast<unsigned char>(text_[at])] : -1;
  }

  std::string_view text_;
  std::size_t at_ = 0;
};

}  // namespace detail

/// The bytes of two digits each.
inline Bytes from_hex(std::string_view text) {
  Bytes bytes;
  bytes.reserve(text.size() / 2);
  for (detail::HexReader reader(text); !reader.at_end();) bytes.push_back(reader.octet());
  return bytes;
}

/// Two digits for each byte.
inline std::string to_hex(std::span<const std::uint8_t> bytes) {
  std::string text;
  text.reserve(2 * bytes.size());
  for (const std::uint8_t byte : bytes) {
    text += "0123456789ABCDEF"[byte >> 4];
    text += "0123456789ABCDEF"[byte & 15];
  }
  return text;
}

/// The bytes of runs, value and length.
inline Bytes from_rle(std::string_view text) {
  Bytes bytes;
  for (detail::HexReader reader(text); !reader.at_end();) {
    const std::uint8_t value = reader.octet();
    bytes.insert(bytes.end(), reader.octet(), value);
  }
  return bytes;
}

/// Changes `array` by a delta. It may have been changed in part if this throws.
inline void apply_delta(std::span<std::uint8_t> array, std::string_view text) {
  std::size_t place = 0;
  for (detail::HexReader reader(text); !reader.at_end();) {
    place += static_cast<std::size_t>(reader.octet()) << 8;
    place += reader.octet();
    for (int runs = reader.octet(); runs > 0; --runs) {
      const std::uint8_t value = reader.octet();
      const std::size_t length = reader.octet();
      if (place + length > array.size())
        throw std::invalid_argument("a delta reaches beyond the " + std::to_string(array.size()) +
                                    " bytes of its field");
      std::fill_n(array.begin() + static_cast<std::ptrdiff_t>(place), length, value);
      place += length;
    }
  }
}

/// The bytes of base64 with padding (RFC 4648).
inline Bytes from_base64(std::string_view text) {
  const std::size_t padding = text.ends_with("==") ? 2 : text.ends_with("=") ? 1 : 0;
  const std::size_t digits = text.size() - padding;
  if (text.size() % 4 != 0) throw std::invalid_argument("the length of base64 is not a multiple of 4");
  Bytes bytes;
  bytes.reserve(text.size() / 4 * 3);
  std::uint32_t bits = 0;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const int value = at < digits ? detail::kBase64Digits[static_cast<unsigned char>(text[at])] : 0;
    if (value < 0)
      throw std::invalid_argument(std::string("not a digit of base64: '").append(1, text[at]).append("'"));
    bits = bits << 6 | static_cast<std::uint32_t>(value);
    if (at % 4 == 3)
      for (const int shift : {16, 8, 0}) bytes.push_back(static_cast<std::uint8_t>(bits >> shift));
  }
  bytes.resize(bytes.size() - padding);
  return bytes;
}

/// Base64 with padding.
inline std::string to_base64(std::span<const std::uint8_t> bytes) {
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - at);
    std::uint32_t bits = 0;
    for (std::size_t byte = 0; byte < 3; ++byte) bits = bits << 8 | (byte < count ? bytes[at + byte] : 0U);
    for (std::size_t digit = 0; digit < 4; ++digit)
      text += digit <= count ? detail::kBase64[bits >> (18 - 6 * digit) & 63] : '=';
  }
  return text;
}

/// The bytes of a zlib stream in base64.
inline Bytes from_zlib(std::string_view text) {
  const Bytes packed = from_base64(text);
  Bytes bytes(std::max<std::size_t>(1024, 8 * packed.size()));
  while (true) {
    auto size = static_cast<uLongf>(bytes.size());
    const int status = uncompress(bytes.data(), &size, packed.data(), static_cast<uLong>(packed.size()));
    const bool may_grow = bytes.size() < 1100 * packed.size();  // zlib packs at most 1032 to 1
    if (status == Z_BUF_ERROR && size == bytes.size() && may_grow) {
      bytes.resize(2 * bytes.size());
    } else if (status == Z_OK) {
      bytes.resize(size);
      return bytes;
    } else {
      throw std::invalid_argument("the zlib stream is damaged");
    }
  }
}

/// Decodes a text. A delta needs an array, apply_delta(), and raw bytes are not a text.
inline Bytes decode(Encoding encoding, std::string_view text) {
  switch (encoding) {
    case Encoding::kHex: return from_hex(text);
    case Encoding::kRle: return from_rle(text);
    case Encoding::kBase64: return from_base64(text);
    case Encoding::kZlib: return from_zlib(text);
    case Encoding::kDelta:
    case Encoding::kRaw: break;
  }
  throw std::invalid_argument("this encoding is not only a text");
}

}  // namespace RACEBEAM_CLIENT_NAMESPACE
