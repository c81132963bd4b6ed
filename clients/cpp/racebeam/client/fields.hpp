/// @file
/// Decodes the fields of the replies to one session. One thread at a time uses a Fields.
#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "racebeam/client/config.hpp"
#include "racebeam/client/field_table.hpp"
#include "racebeam/client/reply.hpp"

namespace RACEBEAM_CLIENT_NAMESPACE::detail {

/// Decodes the fields of replies. It follows what requests that were granted change about later replies.
class Fields {
 public:
  /// Decodes the reply to `request`; `raw` has the bytes that followed its line. Throws std::invalid_argument
  /// if a value cannot be decoded.
  Reply decode_reply(std::string_view request, std::string line, std::string_view raw) {
    std::vector<std::string_view> words;
    for (const std::string_view word : split(request, ' '))
      if (!word.empty()) words.push_back(word);
    const std::string_view command = words.empty() ? std::string_view{} : words[0];
    if (!words.empty()) words.erase(words.begin());
    prepare(command, words, line);
    const bool watches = command == "watch", looks = command == "look" && !words.empty();
    const std::vector<std::string_view> fields = watches ? watched_fields(words) : words;
    const Encodings once = looks || watches ? encodings(fields) : Encodings{};
    const Encodings& chosen = looks || watches ? once : chosen_;
    Source* const watched = watches ? &watched_session(words.at(0), fields, line) : nullptr;
    const std::size_t first = first_machine(command, words);
    raw_ = raw;
    return Reply(std::move(line), [&](Group::Value& value, std::size_t group) {
      decode_value(value, watched != nullptr ? *watched : machine(first + group), chosen);
    });
  }

 private:
  using Encodings = std::map<std::string, Encoding, std::less<>>;

  /// What deltas have made of the fields of a machine, and the height of its screen.
  struct Source {
    std::vector<std::string> fields;  ///< of a watched session
    std::size_t height = 0;
    std::map<std::string, Bytes, std::less<>> arrays;
  };

  static constexpr std::size_t kWidth = 160;

  /// Remembers what a request that was granted changes: the encodings of fields, and the height of screens.
  void prepare(std::string_view command, const std::vector<std::string_view>& words, std::string_view line) {
    if (command == "observe" && !words.empty()) {
      chosen_ = encodings(words);
      machines_.clear();
    } else if (command == "load") {
      const auto height = height_of(line);
      if (!height) throw std::invalid_argument("the reply of load has no height");
      height_ = *height;
      machines_.clear();
    } else if (command == "open") {
      std::erase_if(machines_, [](const auto& machine) { return machine.first > 0; });
    }
  }

  static std::optional<std::size_t> height_of(std::string_view line) {
    constexpr std::string_view kHeight = " height=";
    const std::size_t at = line.find(kHeight);
    if (at == std::string_view::npos) return std::nullopt;
    return to_number<std::size_t>(split(line.substr(at + kHeight.size()), ' ').at(0));
  }

  /// The machine of the first group: 0 is that of load, 1 the first of open, which `machine=0` restores.
  static std::size_t first_machine(std::string_view command, const std::vector<std::string_view>& words) {
    constexpr std::string_view kMachine = "machine=";
    for (const std::string_view word : words)
      if (command == "restore" && word.starts_with(kMachine))
        return to_number<std::size_t>(word.substr(kMachine.size())) + 1;
    return 0;
  }

  Source& machine(std::size_t number) {
    return machines_.try_emplace(number, Source{{}, height_, {}}).first->second;
  }

  /// The fields of a request `watch NAME [since=FRAME] FIELD...`.
  static std::vector<std::string_view> watched_fields(const std::vector<std::string_view>& words) {
    std::vector<std::string_view> fields;
    for (std::size_t at = 1; at < words.size(); ++at)
      if (words[at].find('=') == std::string_view::npos) fields.push_back(words[at]);
    return fields;
  }

  /// A watched session. It begins anew with other fields, and with another height.
  Source& watched_session(std::string_view name, const std::vector<std::string_view>& fields,
                          std::string_view line) {
    Source& source = watched_[std::string(name)];
    const std::size_t height = height_of(line).value_or(height_);
    if (source.height != height || !std::ranges::equal(source.fields, fields))
      source = Source{{fields.begin(), fields.end()}, height, {}};
    return source;
  }

  void decode_value(Group::Value& value, Source& source, const Encodings& chosen) {
    constexpr std::string_view kFinal = "final_";
    const std::string_view field =
        value.key.starts_with(kFinal) ? value.key.substr(kFinal.size()) : value.key;
    const auto found = chosen.find(field);
    if (found == chosen.end()) return;
    value.is_bytes = true;
    if (found->second == Encoding::kRaw) {
      value.bytes = take_raw(to_number<std::size_t>(value.text));
    } else if (found->second == Encoding::kDelta) {
      value.bytes = change_array(source, field, value.text);
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

  /// Applies a delta to the array of a field, and returns the array.
  static const Bytes& change_array(Source& source, std::string_view field, std::string_view delta) {
    auto found = source.arrays.find(field);
    if (found == source.arrays.end())
      found = source.arrays.try_emplace(std::string(field), size(field, source.height)).first;
    Bytes& array = found->second;
    apply_delta(array, delta);
    return array;
  }

  /// The usual encoding of a field; nothing for fields that are not bytes.
  static std::optional<Encoding> usual_encoding(std::string_view field) {
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

  /// The bytes of fields such as grey84x84x4 and rgb40x30x2; 0 for others.
  static std::size_t small_size(std::string_view field) {
    const bool colours = field.starts_with("rgb");
    if (!colours && !field.starts_with("grey")) return 0;
    const auto parts = split(field.substr(colours ? 3 : 4), 'x');
    if (parts.empty()) return 0;
    std::size_t size = colours ? 3 : 1;
    for (const std::string_view part : parts) size *= to_number<std::size_t>(part);
    return parts.size() < 3 ? size * 84 : size;  // grey84 and grey84xN are square
  }

  static std::size_t size(std::string_view field, std::size_t height) {
    for (const auto& [name, bytes] : kSizes)
      if (name == field) return bytes;
    if (const std::size_t small = small_size(field)) return small;
    for (const auto& [name, bytes] : kPixels)
      if (name == field) return height * kWidth * bytes;
    throw std::invalid_argument(std::string("the size of ").append(field).append(" is not known"));
  }

  Encodings chosen_;
  std::map<std::size_t, Source> machines_;  // 0 is that of load
  std::map<std::string, Source> watched_;   // by the name of the session
  std::size_t height_ = 0;
  // Bytes behind the line of the reply that is being decoded, which no field has taken.
  std::string_view raw_;
};

}  // namespace RACEBEAM_CLIENT_NAMESPACE::detail
