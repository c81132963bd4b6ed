#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "racebeam/client/reply.hpp"

namespace racebeam::client::detail {

/// Decodes the fields of replies. It follows what requests that were granted change about later replies.
class Fields {
 public:
  /// The reply to `request`; `raw` has the bytes that followed its line. Throws std::invalid_argument if a
  /// value cannot be decoded.
  Reply follow(std::string_view request, std::string line, std::string_view raw) {
    std::vector<std::string_view> words;
    for (const std::string_view word : split(request, ' '))
      if (!word.empty()) words.push_back(word);
    const std::string_view command = words.empty() ? std::string_view{} : words[0];
    if (!words.empty()) words.erase(words.begin());
    prepare(command, words, line);
    const bool looks = command == "look" && !words.empty();
    const Encodings once = looks ? encodings(words) : Encodings{};
    const Encodings& chosen = looks ? once : chosen_;
    raw_ = raw;
    return Reply(std::move(line),
                 [&](Group::Value& value, std::size_t machine) { decode_value(value, machine, chosen); });
  }

 private:
  using Encodings = std::map<std::string, Encoding, std::less<>>;

  static constexpr std::size_t kWidth = 160;

  void prepare(std::string_view command, const std::vector<std::string_view>& words, std::string_view line) {
    if (command == "observe" && !words.empty()) {
      chosen_ = encodings(words);
      arrays_.clear();
    } else if (command == "load") {
      const std::size_t at = line.find(" height=");
      if (at == std::string_view::npos) throw std::invalid_argument("the reply of load has no height");
      height_ = to_number<std::size_t>(split(line.substr(at + 8), ' ').at(0));
      arrays_.clear();
    } else if (command == "open") {
      std::erase_if(arrays_, [](const auto& array) { return array.first.first > 0; });
    }
  }

  void decode_value(Group::Value& value, std::size_t machine, const Encodings& chosen) {
    constexpr std::string_view kFinal = "final_";
    const std::string_view field =
        value.key.starts_with(kFinal) ? value.key.substr(kFinal.size()) : value.key;
    const auto found = chosen.find(field);
    if (found == chosen.end()) return;
    value.is_bytes = true;
    if (found->second == Encoding::kRaw) {
      value.bytes = take_raw(to_number<std::size_t>(value.text));
    } else if (found->second == Encoding::kDelta) {
      value.bytes = changed(machine, field, value.text);
    } else {
      value.bytes = decode(found->second, value.text);
    }
  }

  Bytes take_raw(std::size_t size) {
    if (size > raw_.size()) throw std::invalid_argument("fewer bytes follow the line than it says");
    const std::string_view bytes = raw_.substr(0, size);
    raw_.remove_prefix(size);
    return {bytes.begin(), bytes.end()};
  }

  const Bytes& changed(std::size_t machine, std::string_view field, std::string_view delta) {
    Bytes& array = arrays_.try_emplace({machine, std::string(field)}, size(field)).first->second;
    apply_delta(array, delta);
    return array;
  }

  /// The usual encoding of a field; nothing for fields that are not bytes.
  static std::optional<Encoding> usual_encoding(std::string_view field) {
    constexpr std::array<std::pair<std::string_view, Encoding>, 7> kUsual{{{"ram", Encoding::kHex},
                                                                           {"tia", Encoding::kHex},
                                                                           {"screen", Encoding::kRle},
                                                                           {"rgb", Encoding::kZlib},
                                                                           {"grey", Encoding::kZlib},
                                                                           {"palette", Encoding::kHex},
                                                                           {"audio", Encoding::kHex}}};
    for (const auto& [name, encoding] : kUsual)
      if (name == field) return encoding;
    if (small_size(field) > 0) return Encoding::kZlib;
    return std::nullopt;
  }

  static Encodings encodings(const std::vector<std::string_view>& fields) {
    Encodings found;
    for (const std::string_view field : fields) {
      const std::size_t colon = field.find(':');
      const std::string_view name = field.substr(0, colon);
      const auto encoding =
          colon == std::string_view::npos ? usual_encoding(name) : encoding_of(field.substr(colon + 1));
      if (encoding) found.insert_or_assign(std::string(name), *encoding);
    }
    return found;
  }

  /// The bytes of fields such as grey84x4 and rgb40x30x2; 0 for others.
  static std::size_t small_size(std::string_view field) {
    const bool colours = field.starts_with("rgb");
    if (!colours && !field.starts_with("grey")) return 0;
    const auto parts = split(field.substr(colours ? 3 : 4), 'x');
    if (parts.empty()) return 0;
    std::size_t size = colours ? 3 : 1;
    for (const std::string_view part : parts) size *= to_number<std::size_t>(part);
    return parts.size() < 3 ? size * 84 : size;  // grey84 and grey84xN are square
  }

  std::size_t size(std::string_view field) const {
    constexpr std::array<std::pair<std::string_view, std::size_t>, 4> kSizes{
        {{"ram", 128}, {"tia", 53}, {"palette", std::size_t{256} * 3}, {"audio", 512}}};
    for (const auto& [name, bytes] : kSizes)
      if (name == field) return bytes;
    if (const std::size_t small = small_size(field)) return small;
    return height_ * kWidth * (field == "rgb" ? 3 : 1);
  }

  Encodings chosen_;
  std::map<std::pair<std::size_t, std::string>, Bytes>
      arrays_;  // what deltas have made; machine 0 is that of load
  std::size_t height_ = 0;
  std::string_view
      raw_;  // bytes behind the line of the reply that is being decoded, which no field has taken
};

}  // namespace racebeam::client::detail
